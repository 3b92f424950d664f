"""Adapters for third-party engines, each a module that imports its library on demand."""
