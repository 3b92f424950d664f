"""Draw images and 3D scenes for reports."""
