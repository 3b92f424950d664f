"""Robots as files for others: one HTML page that needs no server, and glTF."""
