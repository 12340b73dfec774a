"""The planar graph of a drawing: near ends merged, strokes split where they meet, closed outlines found."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from proc3s.domain.values import FloatArray

Edge: TypeAlias = tuple[int, int]

NEAR = 0.01 * 2**0.5  # in diameters: a gap that nobody sees, 1 % of the diagonal of the square around all
DOT = 0.001  # in lengths of the longest stroke: shorter ones are dots
FLAT = 12.0  # degrees: smaller turns of an outline are no corners
TANGLED = 1000  # crossings beyond which nobody can read a drawing


class TangledError(ValueError):
    """The strokes cross in too many points."""


def _edge(i: int, j: int) -> Edge:
    return (i, j) if i < j else (j, i)


@dataclass(frozen=True)
class StrokeGraph:
    """Nodes where strokes end, meet or cross, shape (n, 2), and the straight pieces between them.

    Edges are pairs (i, j) of node indices, i < j. Gaps and stubs up to `tolerance` (canvas units) are gone.
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
        return StrokeGraph(self.nodes, self.edges - {_edge(*edge) for edge in edges}, self.tolerance)

    def length(self, path: Sequence[int]) -> float:
        """Length of a path, given as the indices of its nodes."""
        return float(np.linalg.norm(np.diff(self.nodes[[*path]], axis=0), axis=1).sum())


def stroke_graph(lines: FloatArray) -> StrokeGraph:
    """The graph of n straight lines, shape (n, 4): x and y of one end, x and y of the other.

    It does not depend on the order, direction or repetition of the lines; dots are dropped.
    Raises TangledError if there are more than 1000 crossings.
    """
    strokes = _canonical(lines)
    ends = strokes.reshape(-1, 2)
    tolerance = NEAR * float(np.linalg.norm(ends[:, None] - ends, axis=2).max(initial=0.0))
    meeting = _crossings(strokes)
    if len(meeting) > TANGLED:
        raise TangledError(f"too tangled to read: the strokes cross at {len(meeting)} points")
    feet = nearest_on_segment(ends[:, None], strokes[:, 0], strokes[:, 1])
    beside = np.linalg.norm(feet - ends[:, None], axis=2) <= tolerance
    graph = _split(strokes, np.concatenate([meeting, feet[beside]]), tolerance)
    closed = _gaps_closed(graph)
    if closed.edges != graph.edges:
        # What closes a gap may cross other strokes.
        pieces = closed.nodes[np.array(sorted(closed.edges))]
        graph = _split(pieces, _crossings(pieces), tolerance)
    return _without_stubs(_without_doubles(graph))


def _split(strokes: FloatArray, points: FloatArray, tolerance: float) -> StrokeGraph:
    """Strokes, shape (n, 2, 2), cut at the points, shape (k, 2), that lie on them."""
    points = np.unique(np.concatenate([strokes.reshape(-1, 2), points]), axis=0)
    labels, nodes = _distinct(points, 1e-3 * tolerance)
    edges: set[Edge] = set()
    for a, b in strokes:
        on = np.unique(labels[segment_distance(points, a, b) <= 1e-3 * tolerance])
        path = on[np.argsort((nodes[on] - a) @ (b - a), kind="stable")].tolist()
        edges.update(_edge(*pair) for pair in pairwise(path))
    return StrokeGraph(nodes, frozenset(edges), tolerance)


def _canonical(lines: FloatArray) -> FloatArray:
    """Strokes of shape (n, 2, 2), each from its smaller to its larger end, sorted, unique, no dots."""
    pairs = [sorted([line[:2], line[2:]]) for line in lines.tolist()]
    strokes = np.unique(np.reshape(pairs, (-1, 2, 2)), axis=0)
    length: FloatArray = np.linalg.norm(strokes[:, 1] - strokes[:, 0], axis=1)
    longer: FloatArray = strokes[length > DOT * length.max(initial=0.0)]
    return longer


def _crossings(strokes: FloatArray) -> FloatArray:
    """Points, shape (k, 2), where two of the strokes, shape (n, 2, 2), that are not parallel meet."""
    i, j = np.triu_indices(len(strokes), 1)
    p, q = strokes[i, 0], strokes[j, 0]
    r, s = strokes[i, 1] - p, strokes[j, 1] - q
    det = cross(r, s)
    det[np.abs(det) < 1e-9 * np.linalg.norm(r, axis=1) * np.linalg.norm(s, axis=1)] = np.nan
    t, u = cross(q - p, s) / det, cross(q - p, r) / det
    meet = (t >= 0) & (t <= 1) & (u >= 0) & (u <= 1)
    return np.compress(meet, p + t[:, None] * r, axis=0)


def _distinct(points: FloatArray, same: float) -> tuple[NDArray[np.int64], FloatArray]:
    """For each point the index of the node it is, and the nodes: points closer than `same` are one."""
    labels = np.full(len(points), -1)
    nodes: list[FloatArray] = []
    for k, point in enumerate(points):
        if labels[k] < 0:
            labels[(labels < 0) & (np.hypot(*(points - point).T) <= same)] = len(nodes)
            nodes.append(point)
    return labels, np.array(nodes).reshape(-1, 2)


def _gaps_closed(graph: StrokeGraph) -> StrokeGraph:
    """Loose ends are joined to near loose ends, or else to one near node, unless a short path leads there."""
    ends, links = graph.of_degree(1, 1), {node: {*others} for node, others in graph.neighbours.items()}
    gap = np.linalg.norm(graph.nodes[ends][:, None] - graph.nodes[None], axis=2)
    close = np.argwhere(gap <= graph.tolerance)
    for k, node in close[np.argsort(gap[*close.T], kind="stable")].tolist():
        end, around = ends[k], set(np.flatnonzero(gap[k] <= 3 * graph.tolerance).tolist())
        gaping = node in ends or len(links[end]) == 1
        if gaping and node not in _reachable(links, end, around):
            links[end].add(node)
            links[node].add(end)
    edges = {_edge(node, other) for node, others in links.items() for other in others}
    return StrokeGraph(graph.nodes, frozenset(edges), graph.tolerance)


def _without_doubles(graph: StrokeGraph) -> StrokeGraph:
    """Of strokes drawn on top of each other, one remains: an edge goes if other edges lead along it."""
    nodes, links = graph.nodes, {node: {*others} for node, others in graph.neighbours.items()}
    for i, j in sorted(graph.edges, key=lambda edge: (-graph.length(edge), edge)):
        near = set(np.flatnonzero(segment_distance(nodes, nodes[i], nodes[j]) <= graph.tolerance).tolist())
        links[i].remove(j)
        if j in _reachable(links, i, near):
            links[j].remove(i)
        else:
            links[i].add(j)
    return graph.without(edge for edge in graph.edges if edge[1] not in links[edge[0]])


def _reachable(links: Mapping[int, Collection[int]], start: int, allowed: set[int]) -> set[int]:
    todo, found = [start], {start}
    while todo:
        new = allowed.intersection(links[todo.pop()]) - found
        found |= new
        todo += new
    return found


def _without_stubs(graph: StrokeGraph) -> StrokeGraph:
    """Strokes that overshoot each other leave stubs: they end beside another stroke."""
    while True:
        loose, forks, stubs = set(graph.of_degree(1, 1)), set(graph.of_degree(3)), set[Edge]()
        for path in graph.chains:
            rest = graph.without(pairwise(path))
            if forks & {*path} and (end := loose & {*path}):
                a, b = graph.nodes[np.array(sorted(rest.edges)).T]
                if segment_distance(graph.nodes[end.pop()], a, b).min() <= graph.tolerance:
                    stubs |= graph.edges - rest.edges
        if not stubs:
            return graph
        graph = graph.without(stubs)


def outlines(graph: StrokeGraph) -> list[FloatArray]:
    """The outermost closed curves of the drawing, each a simple polygon (k, 2), counter-clockwise.

    Every other one lies inside one of them. Curves that touch in one point only are two; specks are none.
    """
    nodes, core = graph.nodes, graph
    while leaves := core.of_degree(1, 1):
        core = core.without((leaf, core.neighbours[leaf][0]) for leaf in leaves)
    unseen, loops = set(core.neighbours), list[FloatArray]()
    while unseen:
        lowest = min(unseen, key=lambda node: (nodes[node][1], nodes[node][0]))
        loops += [nodes[loop] for loop in _outer_loops(core, lowest)]
        unseen -= _reachable(core.neighbours, lowest, unseen)
    wide = [loop for loop in loops if cross(loop, np.roll(loop, -1, axis=0)).sum() > graph.tolerance**2]
    return [a for a in wide if not any(inside((a[0] + a[1]) / 2, b) for b in wide if b is not a)]


def _outer_loops(graph: StrokeGraph, start: int) -> list[list[int]]:
    """The simple loops on a walk around a component, the outside on the right, from its lowest node."""
    loops, path, last, first = list[list[int]](), [start], -1, -1
    while True:
        others = graph.neighbours[path[-1]]
        x, y = (graph.nodes[others] - graph.nodes[path[-1]]).T
        order = [others[k] for k in np.argsort(np.arctan2(y, x), kind="stable")]
        # Counter-clockwise from the way back comes the sharpest turn to the right.
        step = order[(order.index(last) + 1) % len(order)] if last >= 0 else order[0]
        if path == [start] and step == first:
            return [loop for loop in loops if len(loop) > 2]
        last, first = path[-1], step if first < 0 else first
        if step in path:
            loops.append(path[path.index(step) :])
            del path[path.index(step) :]
        path.append(step)


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """The z of the cross product of vectors in the plane, shape (..., 2) to (...)."""
    product: FloatArray = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product


def angle_between(a: FloatArray, b: FloatArray) -> FloatArray:
    """Degrees, -180 to 180, by which vector a must turn counter-clockwise to point along b; broadcast."""
    degrees: FloatArray = np.degrees(np.arctan2(cross(a, b), (a * b).sum(axis=-1)))
    return degrees


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
    keep, todo = {0, len(path) - 1}, [(0, len(path) - 1)]
    for i, j in todo:
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
    far = int(np.linalg.norm(ring - ring[0], axis=1).argmax())
    halves = [ring[: far + 1], np.concatenate([ring[far:], ring[:1]])]
    found = np.concatenate([simplify(half, tolerance)[:-1] for half in halves])
    while len(found) > 3 and np.abs(turns(found)).min() < FLAT:
        found = np.delete(found, np.abs(turns(found)).argmin(), axis=0)
    return found


def turns(polygon: FloatArray) -> FloatArray:
    """Degrees by which a closed polygon turns left at each of its points."""
    ahead = np.roll(polygon, -1, axis=0) - polygon
    return angle_between(np.roll(ahead, 1, axis=0), ahead)


def inside(point: FloatArray, polygon: FloatArray) -> bool:
    """Whether a point lies inside a simple polygon, shape (n, 2)."""
    a, b = polygon - point, np.roll(polygon, -1, axis=0) - point
    on_the_left = ((a[:, 1] > 0) != (b[:, 1] > 0)) & ((cross(a, b) > 0) != (b[:, 1] > a[:, 1]))
    return bool(np.count_nonzero(on_the_left) % 2)


def ray_to_circle(origin: FloatArray, direction: FloatArray, centre: FloatArray, radius: float) -> float:
    """How far a ray goes before it meets a circle; 0 from inside, infinity if it misses."""
    unit = direction / np.linalg.norm(direction)
    ahead, beside = float((centre - origin) @ unit), float(cross(unit, centre - origin))
    chord = radius**2 - beside**2
    if ahead**2 <= chord:
        return 0.0
    return ahead - chord**0.5 if ahead > 0 and chord >= 0 else float("inf")
