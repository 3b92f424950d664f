"""Learning robotics step by step: lessons, exercises, and the checks of students' work."""
