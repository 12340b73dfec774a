"""The cache of prepared meshes when there is no room for it."""

import os
import subprocess
import sys

SCRIPT = """
import numpy as np
from proc3s_tabletop.meshes.cache import kept
print(kept("key", lambda: {"a": np.arange(1000)})["a"].sum())
"""


def test_what_cannot_be_kept_is_used_all_the_same(tmp_path):
    done = subprocess.run(
        ["bash", "-c", 'ulimit -f 0; exec "$@"', "bash", sys.executable, "-c", SCRIPT],
        capture_output=True,
        text=True,
        env={**os.environ, "PROC3S_CACHE": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"},
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "499500\n"), done.stderr
    assert "is not kept, and made again next time: File too large" in done.stderr
    assert not list(tmp_path.rglob("*.mesh"))
