"""Adapters of engines of others, each a module that imports its library on demand."""
