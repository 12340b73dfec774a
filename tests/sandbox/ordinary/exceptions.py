# Handles exceptions of its own making, and cleans up.
# expect: plan: repeat(3)
# answer: program
class NoRoom(ValueError):
    pass

def place(n):
    if n < 3:
        raise NoRoom(f"no room for {n}")
    return n

def gen_plan(state):
    for n in range(9):
        try:
            found = place(n)
        except NoRoom as error:
            last = str(error)
        else:
            assert last == "no room for 2"
            return [Action("repeat", [found])]
        finally:
            pass
