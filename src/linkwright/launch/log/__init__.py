"""The log of a launch: on the screen, in files, and through loggers of ``launch.logging``."""
