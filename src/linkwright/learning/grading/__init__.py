"""Grading: the checks of a course, run in the folders of many students."""
