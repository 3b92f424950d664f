import { type ChildProcess, spawn } from "node:child_process";
import { dirname } from "node:path";
import { createInterface } from "node:readline";
import { type Command, environment, extended, shown } from "../server/command.js";
import { addressIn, withoutToken } from "./address.js";

/** A running `linkwright view` of one file. */
export class View {
  /** The address of the page; fails if the program ends before it prints one. */
  readonly address: Promise<string>;
  /** Resolves when the program has ended. */
  readonly ended: Promise<void>;
  private readonly child: ChildProcess;

  /**
   * @param cwd the working directory, where packages are searched too; by default the folder of the file.
   * @param log takes the lines that the program prints.
   */
  constructor(command: Command, file: string, cwd: string | undefined, log: (line: string) => void) {
    const view = extended(command, "view", "--no-open", file);
    log(shown(view));
    const child = spawn(view.program, view.args, {
      cwd: cwd ?? dirname(file),
      env: environment(),
      stdio: ["ignore", "pipe", "pipe"],
    });
    this.child = child;
    this.ended = new Promise((resolve) => {
      child.on("close", () => resolve());
      child.on("error", () => resolve());
    });
    this.address = new Promise((resolve, reject) => {
      createInterface({ input: child.stdout }).on("line", (line) => {
        log(withoutToken(line));
        const address = addressIn(line);
        if (address !== undefined) resolve(address);
      });
      child.on("error", reject);
      child.on("close", (status) => reject(new Error(`linkwright view ended with status ${status ?? "unknown"}`)));
    });
    createInterface({ input: child.stderr }).on("line", log);
    this.address.catch(() => undefined); // who asks for the address handles the error
  }

  /** End the program; the page then says that it is gone. */
  stop(): void {
    this.child.kill();
  }
}
