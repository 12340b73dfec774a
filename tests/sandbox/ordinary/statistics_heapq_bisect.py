# The smaller modules of the standard library.
# expect: plan: draw_line(35, 60, 1, 2)
# answer: program
import bisect
import heapq
import statistics
from collections import Counter, OrderedDict, defaultdict, deque, namedtuple

Pair = namedtuple("Pair", "a b")

def gen_plan(state):
    xs, ys = zip(*((o.x, o.y) for o in state.obstacles))
    heap = [3, 1, 2]
    heapq.heapify(heap)
    assert bisect.bisect_left([1, 2, 3], 2) == 1 and statistics.stdev([1, 2, 3]) == 1
    assert Counter("aab").most_common(1) == [("a", 2)] and deque([1, 2], maxlen=1)[0] == 2
    groups = defaultdict(list)
    groups["x"].append(heapq.heappop(heap))
    pair = Pair(groups["x"][0], OrderedDict(b=2)["b"])
    return [Action("draw_line", [statistics.mean(xs), statistics.median(ys), pair.a, pair.b])]
