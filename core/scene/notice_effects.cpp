#include <string>
#include <vector>

#include "hbar/core/base/error.h"
#include "hbar/core/scene/read_elements.h"

namespace hbar::scene {
namespace {

/// One notice for all elements of which the same is to be said, at the first.
class Several {
 public:
  void add(int line, const std::string& name) {
    line_ = names_.empty() && unnamed_ == 0 ? line : line_;
    if (name.empty()) {
      ++unnamed_;
    } else {
      names_ += (names_.empty() ? "" : ", ") + name;
    }
  }
  void notice(std::string_view element, std::string_view text, ReadContext& context) const {
    if (names_.empty() && unnamed_ == 0) {
      return;
    }
    context.notice(
        line_, concat('<', element, ">: ", text, names_.empty() ? "" : concat(" (", names_, ")")));
  }

 private:
  int line_ = 0;
  int unnamed_ = 0;
  std::string names_;
};

void notice_limits(const Description& description, ReadContext& context) {
  Several joints;
  for (const Robot& robot : description.robots) {
    for (const Link& link : robot.links) {
      const Joint& joint = link.joint;
      if (joint.lim && joint.type != JointType::kFixed && !(joint.lim_stiffness > 0.0)) {
        joints.add(joint.line.number, joint.name);
      }
    }
  }
  joints.notice("joint",
                "lim has no effect on the motion without lim_stiffness, which is 0; it bounds "
                "optimisations alone",
                context);
}

/// What contacts and sensors have: a stiffness, and friction with a slope or a width.
struct Coefficients {
  std::string name;
  int line = 0;
  double kn = 0.0;
  double mu = 0.0;
  bool slides = false;  ///< mu has an effect
};

void notice_coefficients(std::string_view element, std::string_view without_kn,
                         const std::vector<Coefficients>& all, ReadContext& context) {
  Several soft;
  Several smooth;
  for (const Coefficients& c : all) {
    if (!(c.kn > 0.0)) {
      soft.add(c.line, c.name);
    } else if (c.mu > 0.0 && !c.slides) {
      smooth.add(c.line, c.name);
    }
  }
  soft.notice(element, without_kn, context);
  smooth.notice(element, "mu has no effect without kt, which is 0", context);
}

void notice_ground(const Description& description, ReadContext& context) {
  for (const Contact& contact : description.contacts) {
    if (!description.ground && contact.kind == ContactKind::kGround) {
      context.notice(contact.line.number,
                     "<ground_contact>: the scene has no <ground>, so it is the plane z = 0");
    }
  }
}

}  // namespace

void notice_effects(const Description& description, ReadContext& context) {
  notice_limits(description, context);
  notice_ground(description, context);
  for (const ContactKind kind :
       {ContactKind::kGround, ContactKind::kGeneralPrimitive, ContactKind::kCuboidCuboid}) {
    std::vector<Coefficients> contacts;
    for (const Contact& c : description.contacts) {
      if (c.kind == kind) {
        contacts.push_back({c.name.value_or(""), c.line.number, c.kn, c.mu,
                            c.kt > 0.0 || c.friction == Friction::kSmooth});
      }
    }
    notice_coefficients(contact_element(kind), "kn is 0, so nothing is held apart", contacts,
                        context);
  }
  std::vector<Coefficients> sensors;
  for (const TactileSensor& s : description.tactile_sensors) {
    sensors.push_back({s.name, s.line.number, s.kn, s.mu, s.kt > 0.0});
  }
  notice_coefficients("tactile", "kn is 0, so its readings are 0", sensors, context);
}

}  // namespace hbar::scene
