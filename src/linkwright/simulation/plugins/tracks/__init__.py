"""Tracks of vehicles and belts of conveyors."""
