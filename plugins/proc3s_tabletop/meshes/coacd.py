"""Taking a mesh apart by CoACD (Wei et al., SIGGRAPH 2022): hollow and branched bodies, too, but slowly."""

from typing import Any

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.objects.extents import FLAT, thickness

TOLERANCE, CONCAVITY = 0.0022, 0.02
"""How hollow a piece may be, m; or, if more, which share of the body's longest edge."""
OVERLAP = 0.0005
"""Pieces reach so far into their neighbours, m: between the margins around them a groove of 0.13 mm stays."""


def take_apart(mesh: Any, concavity: float | None = None) -> list[FloatArray]:
    """The points (n, 3) of nearly convex parts of a trimesh mesh, m, `concavity` hollow if it is given."""
    import coacd

    coacd.set_log_level("error")
    half = float(np.ptp(mesh.vertices, axis=0).max()) / 2  # what CoACD takes as its unit
    hollow = max(TOLERANCE / half, 2 * CONCAVITY) if concavity is None else 2 * concavity
    parts = coacd.run_coacd(
        coacd.Mesh(mesh.vertices, mesh.faces),
        threshold=min(1.0, hollow),
        extrude=True,
        extrude_margin=OVERLAP / half,
        merge=False,
        # Far less effort than by default, with no loss that shows in the distances of the surfaces.
        mcts_iterations=20,
        mcts_nodes=8,
        mcts_max_depth=1,
        resolution=300,
    )
    return [points for points, _ in parts if thickness(points) > FLAT]
