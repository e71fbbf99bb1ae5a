// What the root of the service answers to programs (api_schemas/service.py); the API document describes `/v1` alone.
export interface ServiceIndex {
  readonly retention_hours: number | null;
  readonly max_pixels: number | null;
  readonly max_upload_bytes: number | null;
}
