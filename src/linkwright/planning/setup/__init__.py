"""The setup of a robot for planning: its groups, its semantic description, and the files of a configuration package."""
