"""Worlds and models as MuJoCo's specification of bodies, joints and shapes."""
