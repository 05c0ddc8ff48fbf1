TEST(Page, NamesLinks) {
  const Model model = builder.build();

  for (const Link& link : model.links()) {
    std::cout << link.name << '\n';
  }
  EXPECT_EQ(model.name(), "page");
}
