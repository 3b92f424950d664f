import type { Modeling } from "../../state/modeling/modeling";
import { strings } from "../../strings";
import { askName } from "../../widgets/dialog";
import { matchesShortcut, type Shortcut } from "../../widgets/shortcuts";

/** The keys of modeling, as in Gazebo and Blender. */
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

/** Elements in which keys enter text. */
const TEXT_SELECTOR = "input:not([type=checkbox]):not([type=range]), textarea, select, [contenteditable]";
const OVERLAY_SELECTOR = "dialog, [role=menu]";
/** Panels have keys of their own; the world's keys also work in the World panel. */
const OTHER_PANELS_SELECTOR = ".panel:not(.world-panel)";

/** The commands for modeling the world, which keys and buttons run. */
export class WorldCommands {
  private readonly actions: Readonly<Record<keyof typeof WORLD_KEYS, () => void>>;

  /** `escape` cancels the drag or the placing in progress. */
  constructor(
    private readonly modeling: Modeling,
    escape: () => void,
  ) {
    this.actions = {
      translate: () => (modeling.gizmo = "translate"),
      rotate: () => (modeling.gizmo = "rotate"),
      scale: () => (modeling.gizmo = "scale"),
      remove: () => modeling.remove(),
      undo: () => modeling.undo(),
      redo: () => modeling.redo(),
      redoToo: () => modeling.redo(),
      copy: () => modeling.copy(),
      paste: () => modeling.paste(),
      duplicate: () => modeling.duplicate(),
      group: () => modeling.groupSelected(),
      ungroup: () => modeling.ungroupSelected(),
      save: () => this.save(),
      saveAs: () => this.saveAs(),
      escape,
    };
  }

  /** Saves the world to its file, or asks for a file if it has none yet. */
  save(): void {
    if (this.modeling.file === null) this.saveAs();
    else this.modeling.save(null);
  }

  saveAs(): void {
    const texts = strings.modeling;
    askName(texts.saveAs, texts.path, this.modeling.file ?? "", (path) => this.modeling.save(path));
  }

  /** Binds the keys, with precedence over those of tools, views and the File menu while the world is modeled. */
  bindKeys(): void {
    document.addEventListener(
      "keydown",
      (event) => {
        if (!this.modeling.isActive || !this.handleKey(event)) return;
        event.preventDefault();
        event.stopImmediatePropagation();
      },
      true,
    );
  }

  private handleKey(event: KeyboardEvent): boolean {
    const names = Object.keys(WORLD_KEYS) as (keyof typeof WORLD_KEYS)[];
    const command = names.find((command) => matchesShortcut(event, WORLD_KEYS[command]));
    const target = event.target instanceof Element ? event.target : null;
    if (command === undefined || target?.closest(OVERLAY_SELECTOR) || target?.closest(OTHER_PANELS_SELECTOR)) return false;
    if (target?.closest(TEXT_SELECTOR)) {
      if (command !== "save" && command !== "saveAs") return false;
      if (target instanceof HTMLElement) target.blur(); // applies the text being typed
    }
    if (command === "copy" && getSelection()?.isCollapsed === false) return false;
    this.actions[command]();
    return true;
  }
}
