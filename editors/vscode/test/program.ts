import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const REPOSITORY = join(dirname(fileURLToPath(import.meta.url)), "..", "..", "..");
const CONFIGURED_PYTHON = process.env["LINKWRIGHT_PYTHON"];
const VENV_PYTHONS = [".venv", ".venv-3.13", ".venv-3.10"].map((name) => join(REPOSITORY, name, "bin", "python"));

/** The Python whose Linkwright the tests run: `LINKWRIGHT_PYTHON`, else an environment of the checkout, else none. */
export const PYTHON = CONFIGURED_PYTHON ?? VENV_PYTHONS.find((file) => existsSync(file));

/** Whether that Python knows PYTHONSAFEPATH, as 3.11 and newer do. */
export const HAS_SAFE_PATH =
  PYTHON !== undefined && spawnSync(PYTHON, ["-c", "import sys; sys.exit(sys.version_info < (3, 11))"]).status === 0;
