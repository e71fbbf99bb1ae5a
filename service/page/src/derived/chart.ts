// A size chart as it is typed, and as the table the service reads.
import type { TapeName } from "../draft/person";

export interface TypedSize {
  readonly label: string;
  /** One for each column, as typed: `94-98`, or `96`. */
  readonly cells: readonly string[];
}

export interface TypedChart {
  readonly columns: readonly TapeName[];
  readonly sizes: readonly TypedSize[];
}

export const EMPTY_CHART: TypedChart = {
  columns: ["chest_girth", "waist_girth_navel", "hip_girth"],
  sizes: ["S", "M", "L"].map((label) => ({ label, cells: ["", "", ""] })),
};

/** As CSV, without rows and columns in which nothing stands; null if nothing stands anywhere. */
export function chartCsv({ columns, sizes }: TypedChart): string | null {
  const rows = sizes.filter(({ cells }) => cells.some(isSaid));
  const kept = columns.map((_, column) => column).filter((column) => rows.some(({ cells }) => isSaid(cells[column] ?? "")));
  if (kept.length === 0) return null;
  const lines = rows.map(({ label, cells }) => [label, ...kept.map((column) => cells[column] ?? "")]);
  return [["size", ...kept.map((column) => columns[column]!)], ...lines].map((line) => `${line.map(quoted).join(",")}\n`).join("");
}

function isSaid(cell: string): boolean {
  return cell.trim() !== "";
}

/** Commas of cells are decimal, those of labels belong to them. */
function quoted(cell: string, column: number): string {
  const text = column === 0 ? cell.trim() : cell.trim().replaceAll(",", ".");
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
