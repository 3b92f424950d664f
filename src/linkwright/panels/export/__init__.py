"""Exports of robots: one HTML page that needs no server, and glTF."""
