"""What a physics engine must do for a table-top: protocols, and the one that is used."""
