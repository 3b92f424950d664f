"""The nodes of slam_toolbox: mapping and localization with laser scans."""
