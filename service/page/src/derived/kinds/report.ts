// The report.
import type { Kind } from "./kind";

export const report: Kind = {
  label: "Report",
  help: "One page to read and to print: pictures, measurements, light.",
  request: () => ({ kind: "report" }),
  pictures: [],
};
