import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import { TOOLS } from "../../scene/tools/catalog";
import type { ToolState, ToolsState } from "../../state/tools";
import { strings } from "../../strings";
import { openMenu } from "../../widgets/menu";

/** The key that fits the whole robot, or the selection, into the view. */
export const FIT_KEY = "Shift F";

/** Returns the name of a tool in the user's language. */
export function translateToolName({ cls, name }: Pick<ToolState, "cls" | "name">): string {
  const names: Readonly<Record<string, string>> = strings.tools.names;
  return names[cls] ?? name;
}

/** RViz's toolbar above the scene, with the tools of the file in their order. */
export class Toolbar {
  readonly element = h("div", { class: "scene-tools", role: "toolbar", aria: { label: strings.tools.label } });
  private readonly buttons = new Map<ToolState, HTMLButtonElement>();

  constructor(
    private readonly tools: ToolsState,
    private readonly fit: () => void,
    private readonly showKeys: () => void,
    /** The button to the right of the tools. */
    private readonly talkButton: HTMLElement,
  ) {
    tools.listChanged.on(() => this.build());
    tools.currentChanged.on(() => this.markCurrent());
    this.element.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.build();
  }

  private build(): void {
    const { tools } = this;
    const texts = strings.tools;
    this.buttons.clear();
    for (const tool of tools.tools) this.buttons.set(tool, this.createToolButton(tool));
    const addButton: HTMLButtonElement = createButton(
      texts.add,
      () => openMenu(addButton, tools.classes.map((tool) => ({ label: translateToolName(tool), run: () => tools.add(tool.cls) }))),
      "scene-tool small",
      createIcon("plus"),
    );
    const removeButton: HTMLButtonElement = createButton(
      texts.remove,
      () => openMenu(removeButton, tools.tools.map((tool) => ({ label: translateToolName(tool), run: () => tools.remove(tool.id) }))),
      "scene-tool small",
      createIcon("minus"),
    );
    removeButton.disabled = tools.tools.length === 0;
    for (const menuButton of [addButton, removeButton]) menuButton.setAttribute("aria-haspopup", "menu");
    const fitButton = createButton(texts.withKey(texts.fitHint, FIT_KEY), this.fit, "scene-tool small fit", createIcon("fit"), h("span", { class: "tool-name" }, texts.fit));
    fitButton.setAttribute("aria-label", texts.fit);
    const helpButton = createButton(texts.help, this.showKeys, "scene-tool small", createIcon("keys"));
    this.element.replaceChildren(...this.buttons.values(), addButton, removeButton, h("span", { class: "spacer" }), fitButton, this.talkButton, helpButton);
    this.markCurrent();
  }

  private createToolButton(tool: ToolState): HTMLButtonElement {
    const entry = TOOLS.get(tool.cls);
    const name = translateToolName(tool);
    const texts = strings.tools;
    const label = tool.isSupported && entry ? texts.withKey(name, entry.key) : texts.unknown(tool.cls);
    const toolIcon = createIcon(entry?.icon ?? "unknown");
    const toolButton = createButton(label, () => this.tools.activate(tool), "scene-tool", toolIcon, h("span", { class: "tool-name" }, name));
    toolButton.setAttribute("aria-label", name);
    toolButton.disabled = !tool.isSupported;
    if (entry) toolButton.setAttribute("aria-keyshortcuts", entry.key);
    return toolButton;
  }

  private markCurrent(): void {
    const { current } = this.tools;
    for (const [tool, toolButton] of this.buttons) {
      toolButton.setAttribute("aria-pressed", String(tool === current));
      toolButton.classList.toggle("active", tool === current);
    }
  }

  /** Moves to the next or previous button with the arrow keys, as in any toolbar. */
  private onKeyDown(event: KeyboardEvent): void {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step === 0) return;
    const buttons = [...this.element.querySelectorAll<HTMLButtonElement>("button:not(:disabled)")];
    const index = buttons.indexOf(document.activeElement as HTMLButtonElement);
    buttons[(index + step + buttons.length) % buttons.length]?.focus();
    event.preventDefault();
  }
}
