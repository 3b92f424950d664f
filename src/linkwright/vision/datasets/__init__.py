"""Pictures of a simulated world with exact labels, to teach detectors with, in COCO and YOLO form."""
