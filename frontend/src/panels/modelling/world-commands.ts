import type { Modelling } from "../../state/modelling/modelling";
import { strings } from "../../strings";
import { askName } from "../../widgets/dialog";
import { matches, type Shortcut } from "../../widgets/shortcuts";

/** The keys of modelling, as Gazebo and Blender have them. */
export const WORLD_KEYS = {
  translate: { key: "t" },
  rotate: { key: "r" },
  scale: { key: "s" },
  remove: { key: "Delete" },
  undo: { key: "z", mod: true },
  redo: { key: "z", mod: true, shift: true },
  redoToo: { key: "y", mod: true },
  copy: { key: "c", mod: true },
  paste: { key: "v", mod: true },
  duplicate: { key: "d", mod: true },
  group: { key: "g", mod: true },
  ungroup: { key: "g", mod: true, shift: true },
  save: { key: "s", mod: true },
  saveAs: { key: "s", mod: true, shift: true },
  escape: { key: "Escape" },
} as const satisfies Readonly<Record<string, Shortcut>>;

/** Where keys are text, or belong to what is open over the page. */
const TEXT = "input:not([type=checkbox]):not([type=range]), textarea, select, [contenteditable]";
const OTHERS = "dialog, [role=menu]";
/** Panels have keys of their own; the world's hold in its own panel. */
const ELSEWHERE = ".panel:not(.world-panel)";

/** The commands of keys and buttons on the world. */
export class WorldCommands {
  private readonly runs: Readonly<Record<keyof typeof WORLD_KEYS, () => void>>;

  /** `escape` releases the entity that the mouse holds, or has in hand. */
  constructor(
    private readonly modelling: Modelling,
    escape: () => void,
  ) {
    this.runs = {
      translate: () => (modelling.gizmo = "translate"),
      rotate: () => (modelling.gizmo = "rotate"),
      scale: () => (modelling.gizmo = "scale"),
      remove: () => modelling.remove(),
      undo: () => modelling.undo(),
      redo: () => modelling.redo(),
      redoToo: () => modelling.redo(),
      copy: () => modelling.copy(),
      paste: () => modelling.paste(),
      duplicate: () => modelling.duplicate(),
      group: () => modelling.group(),
      ungroup: () => modelling.ungroup(),
      save: () => this.save(),
      saveAs: () => this.saveAs(),
      escape,
    };
  }

  /** Into the world's file; where it has none yet, the user is asked for one. */
  save(): void {
    if (this.modelling.file === null) this.saveAs();
    else this.modelling.save(null);
  }

  saveAs(): void {
    const words = strings.modelling;
    askName(words.saveAs, words.path, this.modelling.file ?? "", (path) => this.modelling.save(path));
  }

  /** Takes the keys while the world is modelled: before those of tools, views and the File menu. */
  takeKeys(): void {
    document.addEventListener(
      "keydown",
      (event) => {
        if (!this.modelling.active || !this.pressed(event)) return;
        event.preventDefault();
        event.stopImmediatePropagation();
      },
      true,
    );
  }

  private pressed(event: KeyboardEvent): boolean {
    const names = Object.keys(WORLD_KEYS) as (keyof typeof WORLD_KEYS)[];
    const name = names.find((each) => matches(event, WORLD_KEYS[each]));
    const target = event.target instanceof Element ? event.target : null;
    if (name === undefined || target?.closest(OTHERS) || target?.closest(ELSEWHERE)) return false;
    if (target?.closest(TEXT)) {
      if (name !== "save" && name !== "saveAs") return false;
      if (target instanceof HTMLElement) target.blur(); // what is typed counts
    }
    if (name === "copy" && getSelection()?.isCollapsed === false) return false;
    this.runs[name]();
    return true;
  }
}
