"""Compare the sources of nodes by the names that they offer to other programs.

The sources are not run.
"""
