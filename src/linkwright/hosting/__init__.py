"""Nodes and viewers that run in this process: starting and ending them, their log, signals, reloading of models."""
