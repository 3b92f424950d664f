"""Motion planning for arms, with the interfaces of MoveIt."""
