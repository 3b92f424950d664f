"""Nodes whose callbacks run on a thread of their own, between the steps of a simulation or of a control loop."""
