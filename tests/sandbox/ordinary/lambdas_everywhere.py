# gen_plan and gen_domain are lambdas.
# expect: plan: repeat(2)
gen_plan = lambda state, n: [Action("repeat", [n])]
gen_domain = lambda state: {"n": DiscreteSampler(np.array([2, 2]))}
