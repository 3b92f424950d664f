"""Quality of service: profiles, which of them go together, and which to subscribe with."""
