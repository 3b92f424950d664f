"""Reads SDF worlds and models, resolves includes, and computes poses."""
