"""Adapters for third-party engines, each of which imports its library on demand."""
