"""Worlds and models as a MuJoCo specification of bodies, joints and shapes."""
