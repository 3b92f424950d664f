"""Pictures of a world that moves: by the graphics library of the system, or by rays where it has none."""
