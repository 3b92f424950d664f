import { createButton, h } from "../dom";
import { createIcon } from "../icons";
import { WORLD_KEYS } from "../panels/modeling/world-commands";
import { FIT_KEY, translateToolName } from "../panels/over-scene/toolbar";
import { TERMINAL_KEYS, formatTerminalKey } from "../panels/terminal/terminal-keys";
import { TALK_KEY } from "../panels/voice/talk-button";
import { TOOLS } from "../scene/tools/catalog";
import type { ToolsState } from "../state/tools";
import { strings } from "../strings";
import { formatShortcut, SHORTCUTS } from "../widgets/shortcuts";

type KeyRow = readonly [keys: string, meaning: string];

/** The sheet of all keys of the page, which `?` opens. */
export class KeySheet {
  private dialog: HTMLDialogElement | null = null;

  constructor(private readonly tools: ToolsState) {}

  toggle(): void {
    if (this.dialog) this.dialog.close();
    else this.open();
  }

  private open(): void {
    const texts = strings.keys;
    const dialog = h("dialog", { class: "key-sheet", aria: { label: texts.title } });
    const closeButton = createButton(texts.close, () => dialog.close(), "tool bare", createIcon("close"));
    dialog.append(
      h("header", {}, h("strong", {}, texts.title), h("span", { class: "spacer" }), closeButton),
      h("div", { class: "key-columns" }, ...createKeySections(this.tools)),
    );
    dialog.addEventListener("close", () => {
      this.dialog = null;
      dialog.remove();
    });
    dialog.addEventListener("click", (event) => {
      if (event.target === dialog) dialog.close();
    });
    document.body.append(dialog);
    this.dialog = dialog;
    dialog.showModal();
  }

}

/** Returns the keys of the page, one element for each group. */
export function createKeySections(tools: ToolsState): HTMLElement[] {
  return listSections(tools).map(([title, rows, note]) => createSection(title, rows, note));
}

function listSections(state: ToolsState): (readonly [title: string, rows: readonly KeyRow[], note?: string])[] {
  const texts = strings.keys;
  const { shell, displays, modeling, terminal } = strings;
  const tools = state.tools.flatMap((tool): KeyRow[] => {
    const entry = TOOLS.get(tool.cls);
    return entry ? [[entry.key.toUpperCase(), translateToolName(tool)]] : [];
  });
  return [
    [texts.toolsTitle, tools, texts.toolsNote],
    [
      texts.viewTitle,
      [
        ["F", texts.focus],
        [FIT_KEY, strings.tools.fitHint],
        ["Z", texts.zero],
        ["Shift Z", texts.resetView],
        [texts.arrows, texts.turn],
        [`Shift ${texts.arrows}`, texts.move],
        ["+ -", texts.zoom],
        [`${texts.space} ← →`, strings.timeline.keys],
        ["[ ]", strings.recording.key],
        [strings.simulation.dragKeys, strings.simulation.dragModel],
        [strings.simulation.pushKeys, strings.simulation.pushModel],
      ],
    ],
    [
      texts.treeTitle,
      [
        ["↑ ↓", texts.rows],
        ["← →", texts.open],
        ["Enter", texts.edit],
        [texts.space, texts.toggle],
        [formatShortcut(SHORTCUTS.add), displays.addHint],
        [formatShortcut(SHORTCUTS.duplicate), displays.duplicate],
        [formatShortcut(SHORTCUTS.rename), displays.rename],
        [formatShortcut(SHORTCUTS.remove), displays.remove],
        [`${formatShortcut(SHORTCUTS.moveUp)} ${formatShortcut(SHORTCUTS.moveDown)}`, `${displays.moveUp}, ${displays.moveDown}`],
      ],
    ],
    [
      modeling.label,
      [
        ["T R S", Object.values(modeling.modes).join(", ")],
        [`${formatShortcut(WORLD_KEYS.copy)} ${formatShortcut(WORLD_KEYS.paste)}`, modeling.copyPaste],
        [formatShortcut(WORLD_KEYS.duplicate), modeling.duplicate],
        [formatShortcut(WORLD_KEYS.remove), modeling.remove],
        [formatShortcut(WORLD_KEYS.group), modeling.group],
        [formatShortcut(WORLD_KEYS.ungroup), modeling.ungroup],
        ["Esc", modeling.deselect],
      ],
    ],
    [
      terminal.panel,
      [
        [formatTerminalKey(TERMINAL_KEYS.copy), terminal.copy],
        [formatTerminalKey(TERMINAL_KEYS.paste), terminal.paste],
        [formatTerminalKey(TERMINAL_KEYS.leave), terminal.leave],
        ["← →", terminal.tabKeys],
      ],
    ],
    [
      texts.generalTitle,
      [
        ["Esc", texts.escape],
        [formatShortcut(SHORTCUTS.open), shell.open],
        [formatShortcut(SHORTCUTS.save), shell.save],
        [formatShortcut(SHORTCUTS.saveAs), shell.saveAs],
        [formatShortcut(SHORTCUTS.undo), shell.undo],
        [formatShortcut(SHORTCUTS.redo), shell.redo],
        ["R", texts.resetTime],
        [TALK_KEY.toUpperCase(), strings.voice.talkKey],
        [`${formatShortcut(SHORTCUTS.previousStep)} ${formatShortcut(SHORTCUTS.nextStep)}`, strings.learning.stepKeys],
        [formatShortcut(SHORTCUTS.checkStep), strings.learning.checkHint],
        ["F11", texts.fullscreen],
        ["?", texts.sheet],
      ],
    ],
  ];
}

function createSection(title: string, rows: readonly KeyRow[], note?: string): HTMLElement {
  const list = rows.flatMap(([keys, meaning]) => [h("dt", {}, h("kbd", {}, keys)), h("dd", {}, meaning)]);
  return h("section", {}, h("h2", {}, title), h("dl", {}, ...list), note === undefined ? null : h("p", { class: "hint" }, note));
}
