import type { AddPanelOptions, Direction, DockviewApi, IContentRenderer } from "dockview";
import { h } from "../../dom";
import type { DisplayPanel, PanelHost } from "../../scene/displays/display-panel";
import { formOf } from "./default-layout";
import { PanelTab } from "./panel-tab";

const KEY_PREFIX = "display:";
const PANEL_HEIGHT_PX = 220;
/** The largest share of the window's height for a panel. */
const MAX_HEIGHT_SHARE = 0.3;
/** The number of panels below the Displays panel; further ones become tabs of these. */
const MAX_PANELS_BELOW = 2;
/**
 * Pixels; in a narrow window of at least this width, the first panel opens beside the scene with this share of the
 * width.
 */
const MIN_SPLIT_WIDTH_PX = 600;
const SPLIT_SHARE = 0.42;
/** Pixels; in a lower window, only one panel opens below the Displays panel. */
const MIN_TWO_PANEL_HEIGHT_PX = 700;

interface Placement {
  neighbor: string | undefined;
  direction: Direction;
  width?: number;
  height?: number;
  isInactive?: boolean;
}

/** The panels of displays within the dock. A restored arrangement reserves their places until their displays arrive. */
export class DisplayPanels implements PanelHost {
  private readonly hosts = new Map<string, HTMLElement>();
  private readonly panels = new Map<string, DisplayPanel>();
  /** The panels to bring to the front when their displays offer them; the value is whether they replace the scene. */
  private readonly requestedPanels = new Map<string, boolean>();
  /** The keys of the panels whose places no stored arrangement specifies. */
  private readonly defaultPlacedKeys = new Set<string>();

  /** `getApi` is a function because the dock creates contents while it is itself being created. */
  constructor(private readonly getApi: () => DockviewApi) {}

  offer(panel: DisplayPanel): void {
    this.panels.set(panel.key, panel);
    if (this.getApi().getPanel(panel.key)) {
      this.ensureHost(panel.key).replaceChildren(panel.element);
      this.retitle(panel.key, panel.title);
    } else {
      this.add(panel);
    }
    const replacesScene = this.requestedPanels.get(panel.key);
    if (replacesScene === undefined) return;
    this.requestedPanels.delete(panel.key);
    this.bringToFront(panel.key.slice(KEY_PREFIX.length), replacesScene);
  }

  /**
   * Brings the panel of a display to the front, now or as soon as the display offers one. A panel that replaces the
   * scene moves there, unless a stored arrangement specifies its place.
   */
  bringToFront(display: string, replacesScene: boolean): void {
    const key = KEY_PREFIX + display;
    const api = this.getApi();
    const panel = this.panels.has(key) ? api.getPanel(key) : undefined;
    if (!panel) {
      this.requestedPanels.set(key, replacesScene);
      return;
    }
    const scene = api.getPanel("scene");
    if (replacesScene && scene && this.defaultPlacedKeys.has(key)) {
      const isShared = api.panels.some(({ id, group }) => id !== key && id.startsWith(KEY_PREFIX) && group === scene.group);
      panel.api.moveTo({ group: scene.group, position: isShared ? "right" : "center" });
    }
    panel.api.setActive();
  }

  withdraw(key: string): void {
    this.panels.delete(key);
    this.defaultPlacedKeys.delete(key);
    this.remove(key);
  }

  retitle(key: string, title: string): void {
    this.getApi().getPanel(key)?.api.setTitle(title);
  }

  /** Removes the panels of displays that are not in the list. */
  prune(displays: readonly string[]): void {
    const keys = new Set(displays.map((id) => KEY_PREFIX + id));
    for (const { id } of [...this.getApi().panels]) if (id.startsWith(KEY_PREFIX) && !keys.has(id)) this.withdraw(id);
  }

  /** Adds all panels again after the arrangement was cleared. */
  restore(): void {
    for (const panel of this.panels.values()) if (!this.getApi().getPanel(panel.key)) this.add(panel);
  }

  /** Returns the content of a panel for the dock; null for a panel that belongs to no display. */
  createContent(name: string): IContentRenderer | null {
    if (!name.startsWith(KEY_PREFIX)) return null;
    return { element: this.ensureHost(name), init: () => undefined };
  }

  /** Returns the tab of a panel; null for a panel that belongs to no display. */
  createTab(key: string): PanelTab | null {
    if (!key.startsWith(KEY_PREFIX)) return null;
    const close = (): void => {
      const panel = this.panels.get(key);
      if (panel) panel.onClosed();
      else this.remove(key);
    };
    return new PanelTab(this.panels.get(key)?.icon ?? "image", true, close);
  }

  private add(panel: DisplayPanel): void {
    const { key, title, element } = panel;
    this.defaultPlacedKeys.add(key);
    this.ensureHost(key).replaceChildren(element);
    const openPanels = this.getApi().panels.filter(({ id }) => id.startsWith(KEY_PREFIX));
    const placement = this.choosePlacement(panel, openPanels.at(-1)?.id, openPanels.length);
    const { width, height, isInactive } = placement;
    const options: AddPanelOptions = { id: key, component: key, tabComponent: key, title };
    if (width !== undefined) options.initialWidth = width;
    if (height !== undefined) options.initialHeight = height;
    if (isInactive !== undefined) options.inactive = isInactive;
    const position = placement.neighbor === undefined ? undefined : { referencePanel: placement.neighbor, direction: placement.direction };
    const previousHeights = openPanels.map(({ group }) => ({ group, height: group.height }));
    const { group } = this.getApi().addPanel(position ? { ...options, floating: false, position } : options);
    if (height === undefined) return;
    // The dock takes the space from the other panels: restore their heights.
    for (const entry of [...previousHeights, { group, height }]) entry.group.api.setSize({ height: entry.height });
  }

  /** Returns the place of a new panel, after `panelCount` others. */
  private choosePlacement({ replacesScene }: DisplayPanel, lastPanel: string | undefined, panelCount: number): Placement {
    const api = this.getApi();
    const form = formOf(api);
    const isNarrow = form !== "wide";
    // Where all panels share a group, a new image must not hide the panel that the user works with.
    const sharesGroup = form === "low" || (isNarrow && api.width < MIN_SPLIT_WIDTH_PX);
    const maxPanels = isNarrow || api.height < MIN_TWO_PANEL_HEIGHT_PX ? 1 : MAX_PANELS_BELOW;
    if (lastPanel !== undefined && replacesScene && panelCount < MAX_PANELS_BELOW) return { neighbor: lastPanel, direction: "right" };
    if (lastPanel !== undefined && panelCount >= maxPanels) return { neighbor: lastPanel, direction: "within", isInactive: sharesGroup && !replacesScene };
    const scene = api.getPanel("scene") && "scene";
    if (replacesScene && scene) return { neighbor: scene, direction: "within" };
    if (isNarrow && !sharesGroup && scene) return { neighbor: scene, direction: "right", width: Math.round(api.width * SPLIT_SHARE) };
    const neighbor = api.getPanel("displays") ? "displays" : scene;
    if (sharesGroup) return { neighbor, direction: "within", isInactive: neighbor !== undefined };
    return { neighbor, direction: "below", height: Math.min(PANEL_HEIGHT_PX, Math.round(api.height * MAX_HEIGHT_SHARE)) };
  }

  private remove(key: string): void {
    const panel = this.getApi().getPanel(key);
    if (panel) this.getApi().removePanel(panel);
    this.hosts.delete(key);
  }

  private ensureHost(key: string): HTMLElement {
    let host = this.hosts.get(key);
    if (!host) this.hosts.set(key, (host = h("div", { class: "display-panel-host" })));
    return host;
  }
}
