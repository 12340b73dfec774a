# Searches for a free place itself, with a queue.
# expect: plan: draw_line(0, 0, 0, 20)
# answer: program
from collections import deque

def free(point, obstacles):
    return all(math.hypot(point[0] - o.x, point[1] - o.y) > 15 for o in obstacles)

def gen_plan(state):
    queue, came = deque([(0, 0)]), {(0, 0): None}
    while queue:
        here = queue.popleft()
        if here[1] >= 20:
            break
        for step in ((0, 10), (10, 0)):
            there = (here[0] + step[0], here[1] + step[1])
            if there not in came and free(there, state.obstacles):
                came[there] = here
                queue.append(there)
    return [Action("draw_line", [0, 0, *here])]
