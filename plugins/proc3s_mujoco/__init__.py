"""Table-tops in MuJoCo, with the models of arm and hand that its makers publish; loaded when asked for."""
