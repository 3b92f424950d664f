"""Adapters for third-party engines; each module imports its library on demand."""
