import { Signal } from "../signal";
import type { TextStorage } from "../storage";

export const THEME_CHOICES = ["system", "dark", "light"] as const;
export type ThemeChoice = (typeof THEME_CHOICES)[number];
export type Theme = "dark" | "light";

const STORAGE_KEY = "linkwright.theme";

/** The page's colors: the user's choice, or else the system's. The scene has colors of its own, as in RViz. */
export class ThemeState {
  readonly changed = new Signal<Theme>();
  private currentChoice: ThemeChoice;

  constructor(
    private readonly root: HTMLElement,
    private readonly storage: TextStorage,
    private readonly system: MediaQueryList,
  ) {
    const storedChoice = storage.getItem(STORAGE_KEY);
    this.currentChoice = THEME_CHOICES.find((choice) => choice === storedChoice) ?? "system";
    system.addEventListener("change", () => this.apply());
    this.apply();
  }

  get choice(): ThemeChoice {
    return this.currentChoice;
  }

  get theme(): Theme {
    if (this.currentChoice !== "system") return this.currentChoice;
    return this.system.matches ? "light" : "dark";
  }

  choose(choice: ThemeChoice): void {
    this.currentChoice = choice;
    this.storage.setItem(STORAGE_KEY, choice);
    this.apply();
  }

  private apply(): void {
    const { theme } = this;
    if (this.root.dataset["theme"] === theme) return;
    this.root.dataset["theme"] = theme;
    this.changed.emit(theme);
  }
}
