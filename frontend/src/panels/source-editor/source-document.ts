import { isolateHistory } from "@codemirror/commands";
import { Annotation, ChangeSet, type EditorState, type Text, type Transaction, type TransactionSpec } from "@codemirror/state";
import { mergeChanges, findSmallestChange, toText } from "./document-changes";

/** Marks a transaction that brings a change of the file into the editor. */
const fromDisk = Annotation.define<ChangeSet>();

/** A version of the file that another program wrote, whose changes overlap with unsaved ones. */
interface Conflict {
  readonly text: Text;
  readonly version: number;
}

/** A text that a document had, and its changes since. */
class FormerText {
  changes: ChangeSet;

  constructor(readonly text: Text) {
    this.changes = ChangeSet.empty(text.length);
  }

  /** Returns the position in the current text that corresponds to one in the former text. */
  toCurrentPosition(position: number): number {
    return this.changes.mapPos(Math.min(position, this.text.length));
  }

  /** Returns the position in the former text that corresponds to one in the current text. */
  toFormerPosition(position: number): number {
    return this.changes.invertedDesc.mapPos(position);
  }
}

/** A file in the editor: its edited text, and the last known text on the disk. */
export class SourceDocument {
  conflict: Conflict | null = null;
  /** Why the file cannot be read or written; empty if it can be edited. */
  readOnlyReason = "";
  /** Whether the file does not exist yet; saving creates it. */
  isNew = false;
  /** The position of the first visible line when the document was last shown. */
  scrollPosition = 0;
  /** The text that the shown description was read from; null for the text on the disk. */
  describedText: FormerText | null = null;
  private diskText: Text;
  private unsavedChanges: ChangeSet;
  /** The texts that were sent to be shown in the scene, by their numbers, until the scene shows a newer one. */
  private readonly sentTexts = new Map<number, FormerText>();
  /** The text that was sent to be written, and the changes since; null while nothing is being written. */
  private writing: { text: Text; changes: ChangeSet } | null = null;

  constructor(
    readonly path: string,
    readonly uri: string,
    public version: number,
    public state: EditorState,
  ) {
    this.diskText = state.doc;
    this.unsavedChanges = ChangeSet.empty(state.doc.length);
  }

  get isUnsaved(): boolean {
    return !this.state.doc.eq(this.diskText);
  }

  get isWriting(): boolean {
    return this.writing !== null;
  }

  /** The text on the disk, as far as it was merged. */
  get savedText(): Text {
    return this.diskText;
  }

  /** The text that was sent last to be shown in the scene. */
  get newestSent(): FormerText | undefined {
    return [...this.sentTexts.values()].at(-1);
  }

  /** Returns the position where a line of the shown description is now; 1-based. */
  currentLineOf(line: number): number {
    const text = this.describedText?.text ?? this.diskText;
    const position = text.line(Math.max(1, Math.min(line, text.lines))).from;
    return this.describedText ? this.describedText.toCurrentPosition(position) : this.unsavedChanges.mapPos(position);
  }

  /** Returns the line of the shown description that a position was on; 1-based. */
  describedLineOf(position: number): number {
    const text = this.describedText?.text ?? this.diskText;
    const formerPosition = this.describedText ? this.describedText.toFormerPosition(position) : this.unsavedChanges.invertedDesc.mapPos(position);
    return text.lineAt(Math.min(formerPosition, text.length)).number;
  }

  /** Records that the text is sent to be shown in the scene. */
  recordSent(number: number): void {
    this.sentTexts.set(number, new FormerText(this.state.doc));
  }

  /** Records that the scene shows a text, or cannot show it. */
  recordShown(number: number, isShown: boolean): void {
    if (!isShown) return;
    this.describedText = this.sentTexts.get(number) ?? this.describedText;
    for (const olderNumber of this.sentTexts.keys()) if (olderNumber < number) this.sentTexts.delete(olderNumber);
  }

  /**
   * Returns the transaction that brings an edit of the robot into the text; null if the text has changed at the same
   * place meanwhile.
   *
   * @param baseNumber - the number of the text that was edited; 0 for the one on the disk.
   */
  onRobotEdited(content: string, baseNumber: number): TransactionSpec | null {
    const formerText = this.sentTexts.get(baseNumber);
    const edit = findSmallestChange(formerText?.text ?? this.diskText, toText(content));
    const mergedChanges = mergeChanges(edit, formerText?.changes ?? this.unsavedChanges);
    return mergedChanges && { changes: mergedChanges.edit, annotations: [isolateHistory.of("full")], userEvent: "robot" };
  }

  /** Records a transaction that was applied to the text. */
  record(transaction: Transaction): void {
    this.state = transaction.state;
    if (!transaction.docChanged) return;
    const { changes } = transaction;
    this.unsavedChanges = transaction.annotation(fromDisk) ?? this.unsavedChanges.compose(changes);
    if (this.writing) this.writing.changes = this.writing.changes.compose(changes);
    const formerTexts = new Set(this.sentTexts.values());
    if (this.describedText) formerTexts.add(this.describedText);
    for (const formerText of formerTexts) formerText.changes = formerText.changes.compose(changes);
  }

  /**
   * Adopts a new text of the file; returns the transaction that brings it into the editor, or null if there is none
   * or there is a conflict.
   */
  onDiskChanged(content: string, version: number): TransactionSpec | null {
    const text = toText(content);
    this.version = version;
    this.isNew = false;
    if (text.eq(this.state.doc)) {
      this.rebase(text);
      return null;
    }
    const diskChange = findSmallestChange(this.diskText, text);
    if (diskChange.empty && this.conflict === null) return null;
    const mergedChanges = mergeChanges(diskChange, this.unsavedChanges);
    if (mergedChanges === null) {
      this.conflict = { text, version };
      return null;
    }
    this.diskText = text;
    this.conflict = null;
    return { changes: mergedChanges.edit, annotations: [fromDisk.of(mergedChanges.unsavedChanges), isolateHistory.of("full")], userEvent: "disk" };
  }

  /** Resolves a conflict in favor of the edited text, which is then unsaved. */
  keepMine(): void {
    if (this.conflict) this.rebase(this.conflict.text);
  }

  /**
   * Resolves a conflict in favor of the text on the disk; undoing the returned transaction brings back the edited text.
   */
  takeDisk(): TransactionSpec | null {
    const { conflict } = this;
    if (!conflict) return null;
    const changes = findSmallestChange(this.state.doc, conflict.text);
    this.rebase(conflict.text);
    const noChanges = ChangeSet.empty(conflict.text.length);
    return { changes, annotations: [fromDisk.of(noChanges), isolateHistory.of("full")], userEvent: "disk" };
  }

  /** Returns the text to write. */
  beginWriting(): string {
    this.writing = { text: this.state.doc, changes: ChangeSet.empty(this.state.doc.length) };
    return this.state.doc.toString();
  }

  /** Ends writing: with the version of the file, or null if it was not written. */
  endWriting(version: number | null): void {
    if (this.writing && version !== null) {
      this.diskText = this.writing.text;
      this.unsavedChanges = this.writing.changes;
      this.version = version;
      this.isNew = false;
    }
    this.writing = null;
  }

  private rebase(text: Text): void {
    this.diskText = text;
    this.unsavedChanges = findSmallestChange(text, this.state.doc);
    this.conflict = null;
  }
}
