import type { TopicChoice } from "../protocol";

/**
 * Returns the display class that users most likely want for a topic: the one whose name matches the message type, such
 * as PointCloud2 for PointCloud2, or Image for CompressedImage. Among classes for plain strings, the one whose name
 * occurs in the topic's name. Null if there is none.
 */
export function obviousDisplay({ topic, message, classes }: TopicChoice): string | null {
  const type = shortName(message);
  const byType = classes.filter((cls) => type.includes(shortName(cls)));
  const [closest] = byType.sort((a, b) => shortName(b).length - shortName(a).length);
  const byTopic = classes.find((cls) => topic.includes(firstWord(shortName(cls))));
  return closest ?? byTopic ?? classes[0] ?? null;
}

/** Returns the first word, such as `robot` for RobotModel. */
function firstWord(name: string): string {
  return (/^[A-Z]+[a-z]*/.exec(name)?.[0] ?? name).toLowerCase();
}

function shortName(name: string): string {
  return name.slice(name.lastIndexOf("/") + 1);
}
