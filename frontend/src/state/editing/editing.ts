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

const SNAPPING = "linkwright.editing-snapping";
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
  private text: TextHistory | null = null;
  private link: { display: string; link: string } | null = null;
  private editable: EditableParts | null = null;
  private part: EditablePart | null = null;
  private currentDraft: Draft | null = null;
  /** Whether the draft was written, but the resulting robot has not arrived yet. */
  private isWritten = false;
  private previewNumber = 0;
  private changesAll = false;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private holders = 0;
  private handleMode: HandleMode = "translate";
  private handleFrame: HandleFrame = "parent";

  constructor(
    private readonly connection: Connection,
    storage: TextStorage,
  ) {
    this.snapping = new Snapping(storage, SNAPPING, { on: false, length: 0.01 });
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
      if (display === this.link?.display && this.isWritten) this.reset();
    });
  }

  /** Whether there is an edit to undo: in an unsaved text, or else one that was written. */
  get canUndo(): boolean {
    return this.text?.canUndo ?? this.canUndoWritten;
  }

  get canRedo(): boolean {
    return this.text?.canRedo ?? this.canRedoWritten;
  }

  /** Takes over the history of the unsaved text of the editor of source files; null if all texts are saved. */
  setTextHistory(text: TextHistory | null): void {
    const previous = [this.canUndo, this.canRedo];
    this.text = text;
    if (previous[0] !== this.canUndo || previous[1] !== this.canRedo) this.changed.emit();
  }

  /** Whether editing is active. */
  get isActive(): boolean {
    return this.holders > 0;
  }

  get parts(): readonly EditablePart[] {
    return this.editable?.parts ?? [];
  }

  /** Why nothing can be edited; empty if editing is possible. */
  get unavailableReason(): string {
    return this.editable?.refusal_reason ?? "";
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
  get isOpen(): boolean {
    return this.currentDraft !== null && !this.isWritten;
  }

  /** Whether the edit may change all elements that result from the same text. */
  get isChangeOfAll(): boolean {
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
  hold(): () => void {
    this.holders += 1;
    this.activeChanged.emit();
    this.requestParts();
    this.draftChanged.emit();
    let isDone = false;
    return () => {
      if (!isDone) this.holders -= 1;
      isDone = true;
      if (!this.isActive) this.reset();
      this.activeChanged.emit();
    };
  }

  /** Edits the parts of the link that the user selected; null for none. */
  follow(link: { display: string; link: string } | null): void {
    if (link?.display === this.link?.display && link?.link === this.link?.link) return;
    this.link = link;
    this.editable = this.part = null;
    this.writtenFiles = [];
    this.reset();
    this.requestParts();
  }

  choose(part: EditablePart): void {
    if (isSame(part, this.part)) return;
    this.part = part;
    this.writtenFiles = [];
    this.reset();
  }

  /** Sets the requested values of the chosen part; the preview is requested once the pointer rests. */
  move(draft: Draft): void {
    const { part } = this;
    if (!part || this.unavailableReason !== "") return;
    const isUnmoved = areEqual(draft.xyz, part.xyz) && areEqual(draft.rpy, part.rpy);
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
    this.reset();
    if (this.text) this.text.undo();
    else this.connection.send({ type: "undo_edit" });
  }

  redo(): void {
    this.reset();
    if (this.text) this.text.redo();
    else this.connection.send({ type: "redo_edit" });
  }

  /** Discards the draft. */
  reset(): void {
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
    const xyz = areEqual(currentDraft.xyz, part.xyz) ? null : [...currentDraft.xyz];
    const rpy = areEqual(currentDraft.rpy, part.rpy) ? null : [...currentDraft.rpy];
    const { previewNumber: number, changesAll } = this;
    this.connection.send({ type: "preview_edit", number, display: link.display, part: part.part, name, index, xyz, rpy, together: changesAll });
  }

  /**
   * Handles new parts. The draft stays if the part's own values are unchanged, which means that another part of the
   * robot has changed.
   */
  private setParts(message: EditableParts): void {
    if (message.display !== this.link?.display || message.link !== this.link.link) return;
    this.editable = message;
    const previousPart = this.part;
    this.part = message.parts.find((part) => isSame(part, previousPart)) ?? message.parts[0] ?? null;
    const stays = previousPart && this.part && isSame(previousPart, this.part) && areEqual(previousPart.xyz, this.part.xyz) && areEqual(previousPart.rpy, this.part.rpy);
    if (!stays) this.reset();
    else if (this.isOpen) this.requestPreview();
    this.changed.emit();
    this.draftChanged.emit();
  }
}

function isSame(first: EditablePart, second: EditablePart | null): boolean {
  return second !== null && first.part === second.part && first.name === second.name && first.index === second.index;
}

function areEqual(first: readonly number[], second: readonly number[]): boolean {
  return first.length === second.length && first.every((value, i) => Math.abs(value - (second[i] ?? NaN)) < MIN_CHANGE);
}
