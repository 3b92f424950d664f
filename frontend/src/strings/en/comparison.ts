import { plural } from "./plural";

export const comparison = {
  panel: "Compare",
  list: "Differences",
  count: (count: number): string => plural(count, "difference"),
  same: "The two descriptions say the same.",
  old: "Old",
  new: "New",
  showOld: "Show the old robot, seen through",
  showNew: "Show the new robot",
  alpha: "How opaque the old robot is",
  marks: "Colour what differs",
  marksHint: "Links of the new robot that came or differ, and those of the old one that are gone, have a colour",
  mark: { added: "added", changed: "changed", removed: "removed", old: "old" },
  kinds: { added: "added", removed: "removed", renamed: "renamed", changed: "changed" },
  subjects: { robot: "Robot", link: "Link", joint: "Joint", extension: "Extension" },
  nothing: "none",
  select: (name: string): string => `Select ${name} and look at it`,
};
