"""The classroom: a course in the page, beside the learner's files, robot and terminal."""
