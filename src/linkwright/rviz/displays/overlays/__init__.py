"""The displays that draw over the scene: texts, gauges, plots and images."""
