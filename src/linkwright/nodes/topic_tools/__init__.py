"""The programs of topic_tools: they hand messages of any type from topic to topic."""
