"""Carries topics and services between networks without a common transport, such as DDS and Zenoh."""
