import type { DisplayState } from "../../state/displays";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { askName } from "../../widgets/dialog";
import type { MenuEntry } from "../../widgets/menu";
import { formatShortcut, matchesShortcut, SHORTCUTS } from "../../widgets/shortcuts";
import { AddDialog } from "./add-dialog";

/** The commands for the selected display, or for all selected displays. */
export class DisplayCommands {
  constructor(
    private readonly session: Session,
    private readonly getSelectedDisplay: () => DisplayState | null,
    private readonly listSelectedDisplays: () => readonly DisplayState[],
  ) {}

  add(): void {
    const display = this.getSelectedDisplay();
    new AddDialog(this.session, display?.isGroup === true ? display : null).open();
  }

  duplicate(): void {
    const selectedIds = this.selectedIds;
    if (selectedIds.length > 0) this.session.configuration.duplicate(selectedIds);
  }

  remove(): void {
    const selectedIds = this.selectedIds;
    if (selectedIds.length > 0) this.session.configuration.remove(selectedIds);
  }

  rename(): void {
    const display = this.getSelectedDisplay();
    if (!display) return;
    const { configuration } = this.session;
    const texts = strings.displays;
    askName(texts.renameTitle, texts.name, display.name, (name) => configuration.rename(display.id, name));
  }

  groupSelected(): void {
    const selectedIds = this.selectedIds;
    if (selectedIds.length > 0) this.session.configuration.group(selectedIds, strings.displays.newGroup);
  }

  private get selectedIds(): string[] {
    return this.listSelectedDisplays().map(({ id }) => id);
  }

  /** Moves the display past its neighbor above or below, within its group. */
  move(isUpward: boolean): void {
    const display = this.getSelectedDisplay();
    if (!display) return;
    const { displays, configuration } = this.session;
    const siblings = displays.childrenOf(display.group);
    const index = siblings.indexOf(display);
    const group = display.group?.id ?? null;
    if (isUpward && index > 0) configuration.move([display.id], group, siblings[index - 1]?.id ?? null);
    else if (!isUpward && index < siblings.length - 1) configuration.move([display.id], group, siblings[index + 2]?.id ?? null);
  }

  /** Runs the command of a key and returns whether there was one. On the row of a property, only Add has a key. */
  handleKey(event: KeyboardEvent, isOnDisplay: boolean): boolean {
    const keys: readonly (readonly [keyof typeof SHORTCUTS, () => void])[] = [
      ["add", () => this.add()],
      ["addToo", () => this.add()],
      ["duplicate", () => this.duplicate()],
      ["rename", () => this.rename()],
      ["remove", () => this.remove()],
      ["moveUp", () => this.move(true)],
      ["moveDown", () => this.move(false)],
    ];
    const command = keys.find(([name]) => matchesShortcut(event, SHORTCUTS[name]));
    if (!command || (!command[0].startsWith("add") && !isOnDisplay)) return false;
    command[1]();
    return true;
  }

  /** Returns the context menu of a display. */
  createMenu(display: DisplayState): MenuEntry[] {
    const texts = strings.displays;
    const { session } = this;
    return [
      {
        label: display.isChecked ? texts.disable : texts.enable,
        icon: "check",
        run: () => {
          for (const candidate of this.listSelectedDisplays()) session.setProperty(candidate.enabledId, !display.isChecked);
        },
      },
      { label: texts.addHint, icon: "add", keys: formatShortcut(SHORTCUTS.add), hasLineAbove: true, run: () => this.add() },
      { label: texts.duplicate, icon: "duplicate", keys: formatShortcut(SHORTCUTS.duplicate), run: () => this.duplicate() },
      { label: texts.rename, icon: "rename", keys: formatShortcut(SHORTCUTS.rename), run: () => this.rename() },
      { label: texts.remove, icon: "remove", keys: formatShortcut(SHORTCUTS.remove), run: () => this.remove() },
      { label: texts.group, icon: "Group", hasLineAbove: true, run: () => this.groupSelected() },
      { label: texts.moveUp, keys: formatShortcut(SHORTCUTS.moveUp), run: () => this.move(true) },
      { label: texts.moveDown, keys: formatShortcut(SHORTCUTS.moveDown), run: () => this.move(false) },
    ];
  }
}
