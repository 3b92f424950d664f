import { ChangeSet, Text } from "@codemirror/state";

/** Returns the text of a string, whose lines end with LF. */
export function toText(content: string): Text {
  return Text.of(content.split("\n"));
}

/** Returns the replacement of one range that turns a text into another; empty if the texts are equal. */
export function findSmallestChange(oldText: Text, newText: Text): ChangeSet {
  if (oldText.eq(newText)) return ChangeSet.empty(oldText.length);
  const [oldString, newString] = [oldText.toString(), newText.toString()];
  const minLength = Math.min(oldString.length, newString.length);
  let start = 0;
  while (start < minLength && oldString[start] === newString[start]) start += 1;
  let end = 0;
  while (end < minLength - start && oldString[oldString.length - 1 - end] === newString[newString.length - 1 - end]) end += 1;
  return ChangeSet.of({ from: start, to: oldString.length - end, insert: newString.slice(start, newString.length - end) }, oldString.length);
}

/** A change of the file on the disk, combined with changes that are not saved. */
export interface MergedChange {
  /** The change of the edited text. */
  readonly edit: ChangeSet;
  /** The unsaved changes, relative to the new text on the disk. */
  readonly unsavedChanges: ChangeSet;
}

/**
 * Combines the change of a file with unsaved changes of the same text; null if both changed the same place, so that the
 * user must choose.
 */
export function mergeChanges(diskChange: ChangeSet, unsavedChanges: ChangeSet): MergedChange | null {
  const conflicts: boolean[] = [];
  unsavedChanges.iterChangedRanges((start, end) => void conflicts.push(diskChange.touchesRange(start, end) !== false));
  return conflicts.includes(true) ? null : { edit: diskChange.map(unsavedChanges), unsavedChanges: unsavedChanges.map(diskChange, true) };
}
