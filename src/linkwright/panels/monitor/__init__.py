"""The live panels: plots, topics, the node graph, parameters, the log and the teleop pad."""
