"""Carry topics and services between two networks that have no transport in common, such as DDS and Zenoh."""
