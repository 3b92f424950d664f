"""The substitutes for the packages foxglove_bridge and rosbridge_server, which launch files include."""
