import type { AddPanelOptions, DockviewApi, IContentRenderer } from "dockview";
import { h } from "../dom";
import type { DisplayPanel, PanelHost } from "../scene/displays/display-panel";
import { isNarrow } from "./default-layout";
import { PanelTab } from "./panel-tab";

const PREFIX = "display:";
const HEIGHT = 220;
/** The part of the window's height that is a panel's at most. */
const SHARE = 0.3;
/** So many panels are put below the Displays panel; the next ones become tabs of these. */
const MOST_BESIDE = 2;
/** In a window lower than this, in pixels, only one of them. */
const LOW = 700;

/** The panels of displays within the dock. A restored arrangement keeps their places until their displays come. */
export class DisplayPanels implements PanelHost {
  private readonly hosts = new Map<string, HTMLElement>();
  private readonly offered = new Map<string, DisplayPanel>();

  /** `api` is asked for when it is needed: the dock makes contents while it is being made. */
  constructor(private readonly api: () => DockviewApi) {}

  offer(panel: DisplayPanel): void {
    this.offered.set(panel.key, panel);
    if (this.api().getPanel(panel.key)) {
      this.host(panel.key).replaceChildren(panel.element);
      this.retitle(panel.key, panel.title);
    } else {
      this.add(panel);
    }
  }

  withdraw(key: string): void {
    this.offered.delete(key);
    this.remove(key);
  }

  retitle(key: string, title: string): void {
    this.api().getPanel(key)?.api.setTitle(title);
  }

  /** The displays are these: panels of others go. */
  keep(displays: readonly string[]): void {
    const keys = new Set(displays.map((id) => PREFIX + id));
    for (const { id } of [...this.api().panels]) if (id.startsWith(PREFIX) && !keys.has(id)) this.withdraw(id);
  }

  /** Puts all panels back after the arrangement was cleared. */
  restore(): void {
    for (const panel of this.offered.values()) if (!this.api().getPanel(panel.key)) this.add(panel);
  }

  /** What the dock shows of a panel; null for one that is no display's. */
  content(name: string): IContentRenderer | null {
    if (!name.startsWith(PREFIX)) return null;
    return { element: this.host(name), init: () => undefined };
  }

  /** Its tab; null for one that is no display's. */
  tab(key: string): PanelTab | null {
    if (!key.startsWith(PREFIX)) return null;
    const close = (): void => {
      const panel = this.offered.get(key);
      if (panel) panel.closed();
      else this.remove(key);
    };
    return new PanelTab(this.offered.get(key)?.icon ?? "image", true, close);
  }

  private add(panel: DisplayPanel): void {
    const { key, title, element } = panel;
    this.host(key).replaceChildren(element);
    const others = this.api().panels.filter(({ id }) => id.startsWith(PREFIX));
    const height = Math.min(HEIGHT, Math.round(this.api().height * SHARE));
    const options: AddPanelOptions = { id: key, component: key, tabComponent: key, title, initialHeight: height };
    const last = others.at(-1);
    const crowded = last !== undefined && others.length >= (this.api().height < LOW ? 1 : MOST_BESIDE);
    const beside = crowded ? last.id : ["displays", "scene"].find((id) => this.api().getPanel(id) !== undefined);
    const direction = crowded || isNarrow(this.api()) ? "within" : "below";
    const position = beside === undefined ? undefined : { referencePanel: beside, direction } as const;
    // Where one group has everything, a picture that comes does not hide what the user works with.
    if (isNarrow(this.api()) && beside !== undefined) options.inactive = true;
    const before = others.map(({ group }) => ({ group, height: group.height }));
    const { group } = this.api().addPanel(position ? { ...options, floating: false, position } : options);
    if (direction === "within") return;
    // The dock takes the room from the others.
    for (const each of [...before, { group, height }]) each.group.api.setSize({ height: each.height });
  }

  private remove(key: string): void {
    const panel = this.api().getPanel(key);
    if (panel) this.api().removePanel(panel);
    this.hosts.delete(key);
  }

  private host(key: string): HTMLElement {
    let host = this.hosts.get(key);
    if (!host) this.hosts.set(key, (host = h("div", { class: "display-panel-host" })));
    return host;
  }
}
