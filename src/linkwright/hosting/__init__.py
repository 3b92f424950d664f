"""Nodes and viewers that run in this process.

This includes starting and ending them, their log, signals, and live reload of models.
"""
