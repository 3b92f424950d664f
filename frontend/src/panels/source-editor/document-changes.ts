import { ChangeSet, Text } from "@codemirror/state";

/** Returns the text of a string, whose lines end with LF. */
export function textOf(content: string): Text {
  return Text.of(content.split("\n"));
}

/** Returns the replacement of one range that turns a text into another; empty if the texts are equal. */
export function smallestChange(before: Text, after: Text): ChangeSet {
  if (before.eq(after)) return ChangeSet.empty(before.length);
  const [old, now] = [before.toString(), after.toString()];
  const shortest = Math.min(old.length, now.length);
  let start = 0;
  while (start < shortest && old[start] === now[start]) start += 1;
  let end = 0;
  while (end < shortest - start && old[old.length - 1 - end] === now[now.length - 1 - end]) end += 1;
  return ChangeSet.of({ from: start, to: old.length - end, insert: now.slice(start, now.length - end) }, old.length);
}

/** A change of the file on the disk, combined with changes that are not saved. */
export interface MergedChange {
  /** The change of the edited text. */
  readonly edit: ChangeSet;
  /** The unsaved changes, relative to the new text on the disk. */
  readonly unsaved: ChangeSet;
}

/**
 * Combines the change of a file with unsaved changes of the same text; null if both changed the same place, so that the
 * user must choose.
 */
export function mergeChanges(disk: ChangeSet, unsaved: ChangeSet): MergedChange | null {
  const touched: boolean[] = [];
  unsaved.iterChangedRanges((from, to) => void touched.push(disk.touchesRange(from, to) !== false));
  return touched.includes(true) ? null : { edit: disk.map(unsaved), unsaved: unsaved.map(disk, true) };
}
