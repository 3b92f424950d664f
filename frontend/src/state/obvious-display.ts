import type { TopicChoice } from "../protocol";

/**
 * The display that a topic is for: the one whose name matches the message type, PointCloud2 for PointCloud2, Image for
 * CompressedImage. Among those for plain texts, the one whose name occurs in the topic's name. Null if there is none.
 */
export function obviousDisplay({ topic, message, classes }: TopicChoice): string | null {
  const type = shortName(message);
  const called = classes.filter((cls) => type.includes(shortName(cls)));
  const [closest] = called.sort((a, b) => shortName(b).length - shortName(a).length);
  const spoken = classes.find((cls) => topic.includes(firstWord(shortName(cls))));
  return closest ?? spoken ?? classes[0] ?? null;
}

/** `robot` of RobotModel. */
function firstWord(name: string): string {
  return (/^[A-Z]+[a-z]*/.exec(name)?.[0] ?? name).toLowerCase();
}

function shortName(name: string): string {
  return name.slice(name.lastIndexOf("/") + 1);
}
