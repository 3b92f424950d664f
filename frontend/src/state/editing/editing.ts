import type { Connection } from "../../connection/connection";
import type { DiagnosticItem, EditablePart, EditableParts, EditPreview } from "../../protocol";
import { Signal } from "../../signal";
import type { TextStorage } from "../../storage";
import { Snapping } from "../modeling/snapping";

/**
 * The requested values of the edited part: position in m or components of an axis, and angles in rad, empty for an
 * axis.
 */
export interface Draft {
  readonly xyz: readonly number[];
  readonly rpy: readonly number[];
}

/** The history of an unsaved text. */
interface TextHistory {
  readonly canUndo: boolean;
  readonly canRedo: boolean;
  readonly undo: () => void;
  readonly redo: () => void;
}

export type HandleMode = "translate" | "rotate";
/** The frame along whose axes the handles are oriented. */
export type HandleFrame = "parent" | "own";

const SNAPPING_STORAGE_KEY = "linkwright.editing-snapping";
/** The preview is requested this time after the last change, ms. */
const PREVIEW_DELAY_MS = 120;
const MIN_CHANGE = 1e-9;

/** Editing of a robot: the editable parts, the requested values, and the resulting changes of the files. */
export class EditingState {
  /** The editable parts, the selection, the preview, the undo stack or the refusal changed. */
  readonly changed = new Signal();
  /** The draft of the chosen part changed. */
  readonly draftChanged = new Signal();
  /** Editing started or ended. */
  readonly activeChanged = new Signal();
  /** The user asked to edit a link. */
  readonly editRequested = new Signal();
  readonly snapping: Snapping;
  preview: EditPreview | null = null;
  /** Why nothing was written; null after success. */
  refusal: DiagnosticItem | null = null;
  /** The files written last. */
  writtenFiles: readonly string[] = [];
  /** The editor of source files has the last edit if it concerned an unsaved text. */
  isWrittenToText = false;
  private canUndoWritten = false;
  private canRedoWritten = false;
  private textHistory: TextHistory | null = null;
  private link: { display: string; link: string } | null = null;
  private editableParts: EditableParts | null = null;
  private part: EditablePart | null = null;
  private currentDraft: Draft | null = null;
  /** Whether the draft was written, but the resulting robot has not arrived yet. */
  private isWritten = false;
  private previewNumber = 0;
  private changesAll = false;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private holderCount = 0;
  private handleMode: HandleMode = "translate";
  private handleFrame: HandleFrame = "parent";

  constructor(
    private readonly connection: Connection,
    storage: TextStorage,
  ) {
    this.snapping = new Snapping(storage, SNAPPING_STORAGE_KEY, { on: false, length: 0.01 });
    connection.on("editable_parts", (message) => this.setParts(message));
    connection.on("edit_preview", (message) => {
      if (message.number !== this.previewNumber) return;
      this.preview = message;
      this.changed.emit();
    });
    connection.on("edit_written", ({ files, refusal, is_saved }) => {
      this.isWrittenToText = !is_saved;
      this.refusal = refusal;
      this.writtenFiles = files;
      this.isWritten = refusal === null && this.currentDraft !== null;
      this.preview = null;
      this.changed.emit();
      this.draftChanged.emit();
    });
    connection.on("edit_history", ({ can_undo, can_redo }) => {
      [this.canUndoWritten, this.canRedoWritten] = [can_undo, can_redo];
      this.changed.emit();
    });
    connection.on("description_changed", ({ display }) => {
      if (this.isActive && display === this.link?.display) this.requestParts();
    });
    connection.on("robot_scene", ({ display }) => {
      if (display === this.link?.display && this.isWritten) this.discardDraft();
    });
  }

  /** Whether there is an edit to undo: in an unsaved text, or else one that was written. */
  get canUndo(): boolean {
    return this.textHistory?.canUndo ?? this.canUndoWritten;
  }

  get canRedo(): boolean {
    return this.textHistory?.canRedo ?? this.canRedoWritten;
  }

  /** Takes over the history of the unsaved text of the editor of source files; null if all texts are saved. */
  setTextHistory(textHistory: TextHistory | null): void {
    const previous = [this.canUndo, this.canRedo];
    this.textHistory = textHistory;
    if (previous[0] !== this.canUndo || previous[1] !== this.canRedo) this.changed.emit();
  }

  /** Whether editing is active. */
  get isActive(): boolean {
    return this.holderCount > 0;
  }

  get parts(): readonly EditablePart[] {
    return this.editableParts?.parts ?? [];
  }

  /** Why nothing can be edited; empty if editing is possible. */
  get unavailableReason(): string {
    return this.editableParts?.refusal_reason ?? "";
  }

  get current(): { display: string; link: string } | null {
    return this.link;
  }

  get chosenPart(): EditablePart | null {
    return this.part;
  }

  /** The draft; null if nothing was moved. */
  get draft(): Draft | null {
    return this.currentDraft;
  }

  /** Whether the draft is neither written nor discarded. */
  get isDraftOpen(): boolean {
    return this.currentDraft !== null && !this.isWritten;
  }

  /** Whether the edit may change all elements that result from the same text. */
  get isForAllElements(): boolean {
    return this.changesAll;
  }

  get mode(): HandleMode {
    return this.part?.part === "axis" ? "rotate" : this.handleMode;
  }

  set mode(mode: HandleMode) {
    this.handleMode = mode;
    this.changed.emit();
    this.draftChanged.emit();
  }

  get frame(): HandleFrame {
    return this.handleFrame;
  }

  set frame(frame: HandleFrame) {
    this.handleFrame = frame;
    this.changed.emit();
    this.draftChanged.emit();
  }

  /** Activates editing until the returned function is called. */
  activate(): () => void {
    this.holderCount += 1;
    this.activeChanged.emit();
    this.requestParts();
    this.draftChanged.emit();
    let isReleased = false;
    return () => {
      if (!isReleased) this.holderCount -= 1;
      isReleased = true;
      if (!this.isActive) this.discardDraft();
      this.activeChanged.emit();
    };
  }

  /** Edits the parts of the link that the user selected; null for none. */
  setLink(link: { display: string; link: string } | null): void {
    if (link?.display === this.link?.display && link?.link === this.link?.link) return;
    this.link = link;
    this.editableParts = this.part = null;
    this.writtenFiles = [];
    this.discardDraft();
    this.requestParts();
  }

  choosePart(part: EditablePart): void {
    if (isSamePart(part, this.part)) return;
    this.part = part;
    this.writtenFiles = [];
    this.discardDraft();
  }

  /** Sets the requested values of the chosen part; the preview is requested once the pointer rests. */
  setDraft(draft: Draft): void {
    const { part } = this;
    if (!part || this.unavailableReason !== "") return;
    const isUnmoved = areNearlyEqual(draft.xyz, part.xyz) && areNearlyEqual(draft.rpy, part.rpy);
    this.currentDraft = isUnmoved ? null : draft;
    this.isWritten = this.changesAll = false;
    this.writtenFiles = [];
    this.cancelPreview();
    this.draftChanged.emit();
    if (this.currentDraft) this.timer = setTimeout(() => this.requestPreview(), PREVIEW_DELAY_MS);
  }

  /** Requests the same edit for all elements that result from the same text. */
  changeAll(): void {
    this.changesAll = true;
    this.requestPreview();
    this.changed.emit();
  }

  apply(): void {
    if (!this.preview || this.preview.files.length === 0) return;
    this.connection.send({ type: "apply_edit", number: this.preview.number });
  }

  undo(): void {
    this.discardDraft();
    if (this.textHistory) this.textHistory.undo();
    else this.connection.send({ type: "undo_edit" });
  }

  redo(): void {
    this.discardDraft();
    if (this.textHistory) this.textHistory.redo();
    else this.connection.send({ type: "redo_edit" });
  }

  /** Discards the draft. */
  discardDraft(): void {
    this.currentDraft = null;
    this.isWritten = this.changesAll = false;
    this.cancelPreview();
    this.draftChanged.emit();
  }

  private cancelPreview(): void {
    clearTimeout(this.timer);
    this.previewNumber += 1;
    this.preview = this.refusal = null;
    this.changed.emit();
  }

  private requestParts(): void {
    if (this.isActive && this.link) this.connection.send({ type: "request_editable_parts", ...this.link });
  }

  private requestPreview(): void {
    const { part, currentDraft, link } = this;
    if (!part || !currentDraft || !link) return;
    this.previewNumber += 1;
    this.preview = null;
    const { name, index } = part;
    const xyz = areNearlyEqual(currentDraft.xyz, part.xyz) ? null : [...currentDraft.xyz];
    const rpy = areNearlyEqual(currentDraft.rpy, part.rpy) ? null : [...currentDraft.rpy];
    const { previewNumber, changesAll } = this;
    this.connection.send({ type: "preview_edit", number: previewNumber, display: link.display, part: part.part, name, index, xyz, rpy, together: changesAll });
  }

  /**
   * Handles new parts. The draft stays if the part's own values are unchanged, which means that another part of the
   * robot has changed.
   */
  private setParts(message: EditableParts): void {
    if (message.display !== this.link?.display || message.link !== this.link.link) return;
    this.editableParts = message;
    const previousPart = this.part;
    this.part = message.parts.find((part) => isSamePart(part, previousPart)) ?? message.parts[0] ?? null;
    const keepsDraft =
      previousPart &&
      this.part &&
      isSamePart(previousPart, this.part) &&
      areNearlyEqual(previousPart.xyz, this.part.xyz) &&
      areNearlyEqual(previousPart.rpy, this.part.rpy);
    if (!keepsDraft) this.discardDraft();
    else if (this.isDraftOpen) this.requestPreview();
    this.changed.emit();
    this.draftChanged.emit();
  }
}

function isSamePart(first: EditablePart, second: EditablePart | null): boolean {
  return second !== null && first.part === second.part && first.name === second.name && first.index === second.index;
}

function areNearlyEqual(first: readonly number[], second: readonly number[]): boolean {
  return first.length === second.length && first.every((value, i) => Math.abs(value - (second[i] ?? NaN)) < MIN_CHANGE);
}
