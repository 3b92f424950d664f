import type { Session } from "../../state/session";
import type { ToolState } from "../../state/tools";
import type { Stage } from "../stage";

export type PointerButton = "left" | "middle" | "right";

/** An event of the mouse, a pen or a finger over the scene. */
export interface ToolEvent {
  readonly type: "move" | "down" | "up" | "wheel" | "leave";
  /** Pixels from the canvas' upper left corner, and since the event before. */
  readonly x: number;
  readonly y: number;
  readonly dx: number;
  readonly dy: number;
  /** 120 a notch, positive away from the user. */
  readonly wheel: number;
  /** The button that went down or up. */
  readonly button: PointerButton | null;
  readonly left: boolean;
  readonly middle: boolean;
  readonly right: boolean;
  readonly shift: boolean;
  readonly ctrl: boolean;
  readonly alt: boolean;
  /** Of `up`: the pointer hardly moved since it went down. */
  readonly click: boolean;
}

/** The objects that a tool works with. */
export interface ToolContext {
  readonly stage: Stage;
  readonly session: Session;
  /** Its settings; null for the tool that exists before the server has sent any. */
  readonly state: ToolState | null;
  setHint(text: string): void;
  /** Shows over the scene why it did not do the requested action; an empty text clears that. */
  tell(text: string): void;
  /** A CSS cursor. */
  setCursor(cursor: string): void;
  /** The tool did what it is for: the default one is taken in hand. */
  finish(): void;
}

/** A tool, which handles the mouse while it is in hand: one class for each of RViz's, listed in `catalog.ts`. */
export interface SceneTool {
  /** Gets all keys, those of other tools included; only its own and Escape put it away, as RViz's Select. */
  readonly grabsKeys?: boolean;
  activate?(): void;
  deactivate?(): void;
  pointer(event: ToolEvent): void;
  /** True for a key that it uses. */
  key?(key: string): boolean;
  settingsChanged?(): void;
  /** What tests read. */
  inspect?(): object;
  dispose?(): void;
}

export type SceneToolClass = new (context: ToolContext) => SceneTool;
