"""Quality of service (QoS): profiles, whether they are compatible, and one that fits the publishers of a topic."""
