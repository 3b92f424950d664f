import type { TopicChoice } from "../protocol";

/**
 * Returns the display class that users most likely want for a topic: the one whose name matches the message type, such
 * as PointCloud2 for PointCloud2, or Image for CompressedImage. Among classes for plain strings, the one whose name
 * occurs in the topic's name. Null if there is none.
 */
export function findObviousDisplay({ topic, message, classes }: TopicChoice): string | null {
  const type = shortNameOf(message);
  const classesForType = classes.filter((cls) => type.includes(shortNameOf(cls)));
  const [closestClass] = classesForType.sort((a, b) => shortNameOf(b).length - shortNameOf(a).length);
  const classForTopic = classes.find((cls) => topic.includes(firstWordOf(shortNameOf(cls))));
  return closestClass ?? classForTopic ?? classes[0] ?? null;
}

/** Returns the first word, such as `robot` for RobotModel. */
function firstWordOf(name: string): string {
  return (/^[A-Z]+[a-z]*/.exec(name)?.[0] ?? name).toLowerCase();
}

function shortNameOf(name: string): string {
  return name.slice(name.lastIndexOf("/") + 1);
}
