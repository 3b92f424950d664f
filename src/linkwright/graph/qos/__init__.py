"""Quality of service (QoS): profiles, their compatibility, and how to fit a topic's publishers."""
