"""Robots as the page draws them: links, joints, inertias, and where each was written."""
