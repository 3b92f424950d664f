import type { Session } from "../../state/session";
import type { ToolState } from "../../state/tools";
import type { Stage } from "../stage";

export type PointerButton = "left" | "middle" | "right";

/** An event of a mouse, pen or finger over the scene. */
export interface ToolEvent {
  readonly type: "move" | "down" | "up" | "wheel" | "leave";
  /** The position in pixels from the canvas's upper left corner, and the movement since the last event. */
  readonly x: number;
  readonly y: number;
  readonly dx: number;
  readonly dy: number;
  /** 120 per notch, positive away from the user. */
  readonly wheel: number;
  /** The button that was pressed or released. */
  readonly button: PointerButton | null;
  readonly isLeftDown: boolean;
  readonly isMiddleDown: boolean;
  readonly isRightDown: boolean;
  readonly isShiftDown: boolean;
  readonly isCtrlDown: boolean;
  readonly isAltDown: boolean;
  /** For `up`: whether the pointer hardly moved since the button was pressed. */
  readonly isClick: boolean;
}

/** The objects that a tool uses. */
export interface ToolContext {
  readonly stage: Stage;
  readonly session: Session;
  /** The tool's settings; null for the fallback tool, before the server has sent any. */
  readonly state: ToolState | null;
  setHint(text: string): void;
  /** Shows over the scene why the tool refused a request; an empty text hides the notice. */
  showNotice(text: string): void;
  /** Sets a CSS cursor. */
  setCursor(cursor: string): void;
  /** Ends the tool's task: the default tool becomes active. */
  finish(): void;
}

/** A tool, which handles the mouse while it is active; `catalog.ts` lists one class for each of RViz's tools. */
export interface SceneTool {
  /**
   * Whether the tool receives all keys, those of other tools included; only its own key and Escape then deactivate it,
   * as with RViz's Select.
   */
  readonly grabsKeys?: boolean;
  activate?(): void;
  deactivate?(): void;
  onPointer(event: ToolEvent): void;
  /** Handles a key; returns true if the tool uses it. */
  pressKey?(key: string): boolean;
  onSettingsChanged?(): void;
  /** Returns the tool's state, for tests. */
  inspect?(): object;
  dispose?(): void;
}

export type SceneToolClass = new (context: ToolContext) => SceneTool;
