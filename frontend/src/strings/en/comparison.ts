import { plural } from "./plural";

export const comparison = {
  panel: "Compare",
  list: "Differences",
  count: (count: number): string => plural(count, "difference"),
  same: "The two descriptions are identical.",
  old: "Old",
  new: "New",
  showOld: "Show the old robot, translucent",
  showNew: "Show the new robot",
  alpha: "Opacity of the old robot",
  marks: "Color the differences",
  marksHint: "Color added and changed links of the new robot, and removed links of the old one",
  mark: { added: "added", changed: "changed", removed: "removed", old: "old" },
  kinds: { added: "added", removed: "removed", renamed: "renamed", changed: "changed" },
  subjects: { robot: "Robot", link: "Link", joint: "Joint", extension: "Extension" },
  nothing: "none",
  select: (name: string): string => `Select ${name} and focus on it`,
};
