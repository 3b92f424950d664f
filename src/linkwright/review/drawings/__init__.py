"""What a report shows: images and scenes in 3D."""
