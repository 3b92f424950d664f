"""What makes models act and measure: plugins of both simulators, and sensors, found through entry points."""
