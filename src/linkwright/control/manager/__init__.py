"""The controller manager: loading, switching and updating controllers."""
