TEST(Model, HasLinks) { EXPECT_EQ(links_of_core(), 1);
EXPECT_EQ(links_of_core(), 1);
}
