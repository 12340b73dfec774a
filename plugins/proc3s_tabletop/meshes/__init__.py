"""From a mesh file to convex pieces at rest on the table."""
