"""What sensors give, made usable: filters and conversions of scans, images and inertial measurements."""
