"""Filter and convert sensor data: scans, images and inertial measurements."""
