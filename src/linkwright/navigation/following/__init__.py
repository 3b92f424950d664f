"""Controllers that follow paths, and the checkers of goal and progress."""
