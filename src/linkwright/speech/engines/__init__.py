"""Adapters for third-party engines. Each imports its library on demand."""
