"""Engines that others wrote, each behind a module of its own that loads it when it is asked for."""
