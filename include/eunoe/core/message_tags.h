#ifndef eunoe_core_message_tags_h
#define eunoe_core_message_tags_h

namespace eunoe {

/// Tags of all messages between two ranks. They lie far from those of deal.II, which receives
/// messages of its own tags from any rank on the same communicator.
enum MessageTag : int
{
  tag_rows = 20000,
  tag_row_lengths,
  tag_row_values,
  tag_halo_build,
  tag_halo_update,
  tag_halo_flags,
  tag_halo_paired,
  tag_halo_references,
  tag_table_size,
  tag_table_text,
  tag_entries,
  tag_departure,
  tag_packing
};

} // namespace eunoe

#endif
