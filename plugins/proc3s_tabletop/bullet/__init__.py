"""Everything that names PyBullet."""
