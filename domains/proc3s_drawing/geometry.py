"""The planar graph of a drawing: near ends merged, strokes split where they meet, closed outlines found."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from proc3s.state import FloatArray

Edge: TypeAlias = tuple[int, int]

NEAR = 0.01 * 2**0.5
"""Gap that a person overlooks, as a share of the diameter: 1 % of the diagonal of the square around it."""
DOT = 0.001
"""Strokes shorter than this share of the diameter are dots, no strokes."""
FLAT = 12.0
"""Turns of an outline below this many degrees are no corners."""


def _edge(i: int, j: int) -> Edge:
    return (i, j) if i < j else (j, i)


@dataclass(frozen=True)
class StrokeGraph:
    """Nodes where strokes end, meet or cross, shape (n, 2), and the straight pieces between them.

    Edges are pairs (i, j) of node indices, i < j. Two points closer than `tolerance`, in canvas units,
    count as one. Stubs up to twice that long are gone.
    """

    nodes: FloatArray
    edges: frozenset[Edge]
    tolerance: float

    @cached_property
    def neighbours(self) -> dict[int, list[int]]:
        """The nodes at the other ends of the edges of each node that has any."""
        found: dict[int, list[int]] = {}
        for i, j in sorted(self.edges):
            found.setdefault(i, []).append(j)
            found.setdefault(j, []).append(i)
        return found

    def of_degree(self, low: int, high: float = np.inf) -> list[int]:
        """The nodes at which `low` to `high` edges meet."""
        return [node for node, others in sorted(self.neighbours.items()) if low <= len(others) <= high]

    @cached_property
    def chains(self) -> list[list[int]]:
        """Longest paths whose inner nodes have two edges. A loop without a junction is no chain."""
        found = []
        for start in [*self.of_degree(1, 1), *self.of_degree(3)]:
            for step in self.neighbours[start]:
                path = [start, step]
                while len(others := self.neighbours[path[-1]]) == 2:
                    path.append(others[1] if others[0] == path[-2] else others[0])
                if path <= path[::-1]:
                    found.append(path)
        return found

    def without(self, edges: Iterable[Edge]) -> "StrokeGraph":
        """The same nodes with fewer edges."""
        gone = {_edge(*edge) for edge in edges}
        return StrokeGraph(self.nodes, self.edges - gone, self.tolerance)


def stroke_graph(lines: FloatArray) -> StrokeGraph:
    """The graph of n straight lines, shape (n, 4): x and y of one end, x and y of the other.

    It does not depend on the order, direction or repetition of the lines; dots are dropped.
    """
    strokes = _canonical(lines)
    tolerance = NEAR * _diameter(strokes.reshape(-1, 2))
    same = 1e-3 * tolerance
    points = np.concatenate([strokes.reshape(-1, 2), crossings(strokes)])
    labels, nodes = _distinct(points, same)
    edges: set[Edge] = set()
    for a, b in strokes:
        on = np.unique(labels[segment_distance(points, a, b) <= same])
        path = on[np.argsort((nodes[on] - a) @ (b - a), kind="stable")].tolist()
        edges.update(_edge(*pair) for pair in pairwise(path))
    graph = StrokeGraph(nodes, frozenset(edges), tolerance)
    return _without_stubs(_without_doubles(_gaps_closed(graph)))


def _canonical(lines: FloatArray) -> FloatArray:
    """Strokes of shape (n, 2, 2), each from its smaller to its larger end, sorted, unique, no dots."""
    strokes = np.array(lines, dtype=np.float64).reshape(-1, 2, 2)
    swap = [tuple(a) > tuple(b) for a, b in strokes.tolist()]
    strokes[swap] = strokes[swap][:, ::-1]
    unique: FloatArray = np.unique(strokes, axis=0)
    length = np.linalg.norm(unique[:, 1] - unique[:, 0], axis=1)
    return unique[length > DOT * _diameter(unique[length > 0].reshape(-1, 2))]


def _diameter(points: FloatArray) -> float:
    return float(np.linalg.norm(points[:, None] - points[None], axis=2).max(initial=0.0))


def crossings(strokes: FloatArray) -> FloatArray:
    """Points, shape (k, 2), where two of the strokes, shape (n, 2, 2), that are not parallel meet; sorted."""
    i, j = np.triu_indices(len(strokes), 1)
    p, q = strokes[i, 0], strokes[j, 0]
    r, s = strokes[i, 1] - p, strokes[j, 1] - q
    det = cross(r, s)
    slanted = np.abs(det) > 1e-9 * np.linalg.norm(r, axis=1) * np.linalg.norm(s, axis=1)
    p, q, r, s, det = p[slanted], q[slanted], r[slanted], s[slanted], det[slanted]
    t, u = cross(q - p, s) / det, cross(q - p, r) / det
    meet = (t >= 0) & (t <= 1) & (u >= 0) & (u <= 1)
    return np.unique(p[meet] + t[meet, None] * r[meet], axis=0)


def _distinct(points: FloatArray, same: float) -> tuple[NDArray[np.int64], FloatArray]:
    """For each point the index of the node it is, and the nodes: points closer than `same` are one."""
    nodes = np.empty_like(points)
    labels = np.empty(len(points), dtype=np.int64)
    count = 0
    for k, point in enumerate(points):
        close = np.flatnonzero(np.hypot(*(nodes[:count] - point).T) <= same)
        if len(close) == 0:
            nodes[count] = point
            count += 1
        labels[k] = close[0] if len(close) else count - 1
    return labels, nodes[:count]


def _gaps_closed(graph: StrokeGraph) -> StrokeGraph:
    """Loose ends within the tolerance are joined, nearest first; then those just short of a node or edge."""
    ends = graph.of_degree(1, 1)
    where = graph.nodes[ends]
    gap = np.linalg.norm(where[:, None] - where[None], axis=2)
    close = np.argwhere(np.triu(gap <= graph.tolerance, 1))
    for a, b in close[np.argsort(gap[*close.T], kind="stable")].tolist():
        i, j = ends[a], ends[b]
        if len(graph.neighbours[i]) == len(graph.neighbours[j]) == 1 and (i, j) not in graph.edges:
            graph = StrokeGraph(graph.nodes, graph.edges | {(i, j)}, graph.tolerance)
    for end in ends:
        if len(graph.neighbours[end]) == 1:
            graph = _loose_end_joined(graph, end)
    return graph


def _loose_end_joined(graph: StrokeGraph, end: int) -> StrokeGraph:
    nodes, near, own = graph.nodes, graph.tolerance, graph.neighbours[end][0]
    others = [edge for edge in sorted(graph.edges) if end not in edge]
    if not others:
        return graph
    free = sorted({*chain.from_iterable(others)} - {own})
    away = np.linalg.norm(nodes[free] - nodes[end], axis=1)
    if away.min() <= near:
        return StrokeGraph(nodes, graph.edges | {_edge(end, free[int(away.argmin())])}, near)
    feet = nearest_on_segment(nodes[end], *nodes[np.array(others).T])
    away = np.linalg.norm(feet - nodes[end], axis=1)
    # At its own corner an end is always near the other stroke: that is no gap.
    corner = np.array([own in edge for edge in others]) & (np.linalg.norm(feet - nodes[own], axis=1) <= near)
    away[corner] = np.inf
    if away.min() > near:
        return graph
    (i, j), foot, new = others[int(away.argmin())], feet[[int(away.argmin())]], len(nodes)
    edges = graph.edges - {(i, j)} | {(i, new), (j, new), (end, new)}
    return StrokeGraph(np.concatenate([nodes, foot]), edges, near)


def _without_doubles(graph: StrokeGraph) -> StrokeGraph:
    """Of strokes drawn on top of each other, one remains: an edge goes if other edges lead along it."""
    nodes = graph.nodes
    for i, j in sorted(graph.edges, key=lambda edge: -np.linalg.norm(nodes[edge[0]] - nodes[edge[1]])):
        near = set(np.flatnonzero(segment_distance(nodes, nodes[i], nodes[j]) <= graph.tolerance).tolist())
        beside = [node for node in graph.neighbours[i] if node in near and node != j]
        if any(j in _reachable(graph, node, near - {i}) for node in beside):
            graph = graph.without([(i, j)])
    return graph


def _reachable(graph: StrokeGraph, start: int, allowed: set[int]) -> set[int]:
    todo, found = [start], {start}
    while todo:
        new = allowed.intersection(graph.neighbours[todo.pop()]) - found
        found |= new
        todo += new
    return found


def _without_stubs(graph: StrokeGraph) -> StrokeGraph:
    """Strokes that overshoot each other leave stubs; at an acute corner twice as long as the overshoot."""
    loose, forks = set(graph.of_degree(1, 1)), set(graph.of_degree(3))
    stubs = [
        path
        for path in graph.chains
        if loose & {path[0], path[-1]}
        and forks & {path[0], path[-1]}
        and path_length(graph.nodes[path]) <= 2 * graph.tolerance
    ]
    return graph.without(edge for path in stubs for edge in pairwise(path))


def outlines(graph: StrokeGraph) -> list[FloatArray]:
    """The outermost closed curves of the drawing, each a simple polygon (k, 2), counter-clockwise.

    Every other closed curve lies inside one of them. Curves that touch in one point only are two curves;
    curves narrower than half the tolerance are none.
    """
    core = graph
    while leaves := core.of_degree(1, 1):
        core = core.without((leaf, core.neighbours[leaf][0]) for leaf in leaves)
    parts = []
    for members in _components(core):
        loops = (graph.nodes[loop] for loop in _simple_loops(_outer_walk(core, members)))
        parts.append([loop for loop in loops if _width(loop) > graph.tolerance / 2])
    return [
        loop
        for part in parts
        for loop in part
        if not any(inside(loop[0], other) for rest in parts if rest is not part for other in rest)
    ]


def _components(graph: StrokeGraph) -> list[list[int]]:
    found: list[list[int]] = []
    unseen = set(graph.neighbours)
    while unseen:
        found.append(sorted(_reachable(graph, min(unseen), unseen)))
        unseen -= {*found[-1]}
    return found


def _outer_walk(graph: StrokeGraph, members: list[int]) -> list[int]:
    """Once around a component with the outside on the right, from its lowest node back to it."""
    nodes = graph.nodes

    def rightmost(at: int, back: FloatArray) -> int:
        def turn(other: int) -> float:
            ahead = nodes[other] - nodes[at]
            angle = float(np.arctan2(cross(back, ahead), back @ ahead)) % (2 * np.pi)
            return angle if angle > 1e-12 else 2 * np.pi

        return min(graph.neighbours[at], key=turn)

    start = min(members, key=lambda node: (nodes[node][1], nodes[node][0]))
    walk = [start, rightmost(start, np.array([0.0, -1.0]))]
    while True:
        step = rightmost(walk[-1], nodes[walk[-2]] - nodes[walk[-1]])
        if walk[-1] == start and step == walk[1]:
            return walk
        walk.append(step)


def _simple_loops(walk: list[int]) -> list[list[int]]:
    loops, open_path = [], list[int]()
    for node in walk:
        if node in open_path:
            at = open_path.index(node)
            loops.append(open_path[at:])
            del open_path[at:]
        open_path.append(node)
    return [loop for loop in loops if len(loop) > 2]


def _width(polygon: FloatArray) -> float:
    """Width of a long rectangle of the same area and perimeter; negative if the polygon runs clockwise."""
    doubled_area = float(cross(polygon, np.roll(polygon, -1, axis=0)).sum())
    return doubled_area / path_length(np.concatenate([polygon, polygon[:1]]))


def path_length(path: FloatArray) -> float:
    """Length of an open path of points, shape (n, 2)."""
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """The z of the cross product of vectors in the plane, shape (..., 2) to (...)."""
    product: FloatArray = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product


def angle_between(a: FloatArray, b: FloatArray) -> float:
    """Degrees, -180 to 180, by which vector a must turn counter-clockwise to point along b."""
    return float(np.degrees(np.arctan2(cross(a, b), a @ b)))


def nearest_on_segment(point: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
    """The point of the segment from a to b that is nearest; shapes (2,) or (n, 2), broadcast together."""
    along = b - a
    t = ((point - a) * along).sum(axis=-1) / np.maximum((along * along).sum(axis=-1), 1e-300)
    nearest: FloatArray = a + np.clip(t, 0.0, 1.0)[..., None] * along
    return nearest


def segment_distance(point: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
    """Distance to the segment from a to b; shapes (2,) or (n, 2), broadcast together."""
    distance: FloatArray = np.linalg.norm(point - nearest_on_segment(point, a, b), axis=-1)
    return distance


def simplify(path: FloatArray, tolerance: float) -> FloatArray:
    """The path, shape (n, 2), without points that are nearer than `tolerance` to it (Douglas-Peucker)."""
    keep = {0, len(path) - 1}
    todo = [(0, len(path) - 1)]
    while todo:
        i, j = todo.pop()
        off = segment_distance(path[i + 1 : j], path[i], path[j])
        if off.max(initial=0.0) > tolerance:
            k = i + 1 + int(off.argmax())
            keep.add(k)
            todo += [(i, k), (k, j)]
    return path[sorted(keep)]


def corners(polygon: FloatArray, tolerance: float) -> FloatArray:
    """The corners that a person sees in a closed polygon, shape (n, 2), in its order; at least 12 degrees."""
    first = int(np.linalg.norm(polygon - polygon.mean(axis=0), axis=1).argmax())
    ring = np.roll(polygon, -first, axis=0)
    half = int(np.linalg.norm(ring - ring[0], axis=1).argmax())
    there = simplify(ring[: half + 1], tolerance)
    back = simplify(np.concatenate([ring[half:], ring[:1]]), tolerance)
    found = np.concatenate([there[:-1], back[:-1]])
    while len(found) > 3 and np.abs(turns(found)).min() < FLAT:
        found = np.delete(found, np.abs(turns(found)).argmin(), axis=0)
    return found


def turns(polygon: FloatArray) -> FloatArray:
    """Degrees by which a closed polygon turns left at each of its points."""
    ahead = np.roll(polygon, -1, axis=0) - polygon
    before = np.roll(ahead, 1, axis=0)
    degrees: FloatArray = np.degrees(np.arctan2(cross(before, ahead), (before * ahead).sum(axis=1)))
    return degrees


def inside(point: FloatArray, polygon: FloatArray) -> bool:
    """Whether a point lies inside a simple polygon, shape (n, 2)."""
    a, b = polygon - point, np.roll(polygon, -1, axis=0) - point
    spans = (a[:, 1] > 0) != (b[:, 1] > 0)
    left = (cross(a, b) > 0) != (b[:, 1] > a[:, 1])
    return bool(np.count_nonzero(spans & left) % 2)


def clearance(point: FloatArray, polygon: FloatArray) -> float:
    """Distance of a point to the nearest side of a polygon, inside or outside."""
    return float(segment_distance(point, polygon, np.roll(polygon, -1, axis=0)).min())


def ray_to_circle(origin: FloatArray, direction: FloatArray, centre: FloatArray, radius: float) -> float:
    """How far a ray goes before it meets a circle; 0 from inside, infinity if it misses."""
    unit = direction / np.linalg.norm(direction)
    ahead, beside = float((centre - origin) @ unit), float(cross(unit, centre - origin))
    if np.hypot(ahead, beside) <= radius:
        return 0.0
    if ahead < 0 or abs(beside) > radius:
        return float("inf")
    return ahead - float(np.sqrt(radius**2 - beside**2))
