// Parameters of contact between bodies: [contact], [contact_pair.NAME].
#include "config/table_declaration.hpp"

namespace thawslide::config {

namespace {

const char* const friction_text = "friction angle between bodies that are in contact";
const Range friction_range{.low = 0, .high = 90, .high_open = true};

std::vector<Parameter<Contact>> contact_parameters() {
  const auto is_frictional = [](const Case&, const Contact& contact) {
    return contact.between_bodies == BodyContact::frictional;
  };
  const std::string when = "when contact.between_bodies is \"frictional\"";
  return {
      parameter(&Contact::between_bodies, {.key = "between_bodies",
                                           .text = "contact between bodies without a [contact_pair.NAME]",
                                           .source = "Bardenhagen et al. (2000); Nairn (2013)"}),
      parameter(&Contact::friction_angle,
                {.key = "friction_angle", .unit = "degrees", .range = friction_range, .text = friction_text})
          .required_if(when, is_frictional)
          .only_if(when, "between_bodies", is_frictional),
  };
}

std::vector<Parameter<ContactPair>> pair_parameters() {
  const auto is_frictional = [](const Case&, const ContactPair& pair) {
    return pair.contact == BodyContact::frictional;
  };
  const std::string when = "when the pair's contact is \"frictional\"";
  return {
      parameter(&ContactPair::bodies, {.key = "bodies", .text = "names of the two bodies"}).required(),
      parameter(&ContactPair::contact, {.key = "contact", .text = "contact between the two bodies"}).required(),
      parameter(&ContactPair::friction_angle,
                {.key = "friction_angle", .unit = "degrees", .range = friction_range, .text = friction_text})
          .required_if(when, is_frictional)
          .only_if(when, "contact", is_frictional),
  };
}

}  // namespace

void declare_contact(Tables& tables) {
  tables.push_back(std::make_unique<SingleTable<Contact>>("contact", "Contact between bodies", &Case::contact,
                                                          contact_parameters()));
  tables.push_back(std::make_unique<NamedTable<ContactPair>>("contact_pair",
                                                             "Contact between two bodies, with a name of your choice",
                                                             &Case::contact_pairs, pair_parameters()));
}

}  // namespace thawslide::config
