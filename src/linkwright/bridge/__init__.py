"""Carry topics and services between networks, such as DDS and Zenoh."""
