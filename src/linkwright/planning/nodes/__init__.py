"""The nodes of MoveIt."""
