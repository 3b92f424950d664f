"""Markers: conversion of visualization_msgs to the form that pages draw."""

from linkwright.rviz.markers.shapes import BadMarkerError, MarkerReading, MarkerStore, read_marker

__all__ = ["BadMarkerError", "MarkerReading", "MarkerStore", "read_marker"]
