// Shares as a person reads them.

export function percent(share: number): string {
  return share > 0 && share < 0.005 ? "less than 1 %" : `${Math.round(100 * share)} %`;
}
