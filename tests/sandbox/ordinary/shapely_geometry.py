# Wants shapely, which is optional: where it is missing, the message says what there is.
# expect: SketchRuntimeError line 6: ModuleNotFoundError: No module named 'shapely'
# friendly: SketchRuntimeError line 6: ImportError: 'shapely.geometry' cannot be imported here; available: __future__, abc, bisect, cmath, collections
# installed: plan: repeat(1)
# answer: program
from shapely.geometry import LineString, Point

def gen_plan(state):
    line = LineString([(0, 0), (10, 0)])
    free = all(line.distance(Point(o.x, o.y)) > 5 for o in state.obstacles)
    return [Action("repeat", [1 if free else 2])]
