"""Read SDF worlds and models, with their includes resolved and poses computed."""
