# Prints as it goes, also to a file object and with every option.
# expect: plan: repeat(1)
# log: plan for object_0, object_1|end
# answer: program
def gen_plan(state):
    print("plan for", ", ".join(o.name for o in state.obstacles), sep=" ", end="|", flush=True)
    print("end")
    return [Action("repeat", [1])]
