"""Compare launch files: their actions, the settings of these, and the other code."""
