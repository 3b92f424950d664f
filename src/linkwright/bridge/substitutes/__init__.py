"""The substitute for the package foxglove_bridge, which launch files include, with its share directory."""
