"""Quality of service (QoS): profiles, their compatibility, and the best match for a topic."""
