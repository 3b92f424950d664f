"""Controllers that follow paths, and checkers of the goal and of progress."""
